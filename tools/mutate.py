"""Makes mutants of passes/: each replaces one token sequence of one file. The seed alone decides which. Mutants that do not compile, and those
that compile to the same code, are counted and replaced by the next."""
import collections
import hashlib
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

import mechanism_rows
from pages import preset

SEED = 7
SHARE, FEWEST, MOST = 0.015, 1, 2  # mutants per file, as a fraction of all possible ones
# Not functions: constants that the host sets, and lists of rows.
LEFT_OUT = ("shared/interface.glsl", "shared/end_reasons.glsl")

TOKEN = re.compile(r"""(?P<skip>\s+|//[^\n]*|/\*.*?\*/|\#(?:\\\n|[^\n])*)|(?P<text>"(?:\\.|[^"\\])*")|(?P<word>[A-Za-z_]\w*)
    |(?P<number>0[xX][0-9a-fA-F]+[uU]?|(?:\d+\.\d*|\.\d+|\d+)(?:[eE][+-]?\d+)?[uUfF]?)
    |(?P<sign><<=|>>=|<<|>>|<=|>=|==|!=|&&|\|\||\+\+|--|[-+*/%&|^]=|->|.)""", re.X | re.S | re.M)
Token = collections.namedtuple("Token", "kind text start end")
Mutant = collections.namedtuple("Mutant", "file start end new operator")

TURNED = {"<": ">", ">": "<", "<=": ">=", ">=": "<=", "==": "!=", "!=": "==", "lessThan": "greaterThan", "greaterThan": "lessThan",
          "lessThanEqual": "greaterThanEqual", "greaterThanEqual": "lessThanEqual", "equal": "notEqual", "notEqual": "equal"}
OPEN, CLOSE = {"(": ")", "[": "]", "{": "}"}, {")", "]", "}"}
OPERATORS = ("comparison turned", "constant changed", "guard removed", "clamp removed", "epsilon removed", "term dropped", "sign exchanged",
             "axes exchanged")


def tokens_of(text):
    return [Token(m.lastgroup, m.group(), m.start(), m.end()) for m in TOKEN.finditer(text) if m.lastgroup != "skip"]


class Source:
    """The tokens of a file, and its possible mutants."""

    def __init__(self, file, text):
        self.file, self.text, self.tokens = file, text, tokens_of(text)
        self.partner, open_ = {}, []
        for i, token in enumerate(self.tokens):
            if token.text in OPEN:
                open_.append(i)
            elif token.text in CLOSE and open_:  # the block of push constants begins in another file
                self.partner[open_[-1]] = i
                self.partner[i] = open_.pop()

    def word(self, i):
        return self.tokens[i].text if 0 <= i < len(self.tokens) else ""

    def between(self, first, last):
        """The text of tokens first to last - 1."""
        return self.text[self.tokens[first].start:self.tokens[last - 1].end] if last > first else ""

    def is_binary(self, i):
        before = self.tokens[i - 1] if i else None
        return before is not None and (before.kind in ("number", "word") and before.text != "return" or before.text in (")", "]"))

    def after_factor(self, i):
        while self.word(i) in ("-", "+", "!", "~"):
            i += 1
        i = self.partner[i] + 1 if self.word(i) == "(" else i + 1
        while self.word(i) in ("(", "[", "."):
            i = i + 2 if self.word(i) == "." else self.partner[i] + 1
        return i

    def after_term(self, i):
        i = self.after_factor(i)
        while self.word(i) in ("*", "/", "%"):
            i = self.after_factor(i + 1)
        return i

    def after_logic(self, i):
        while self.word(i) not in ("&&", "||", "?", ":", ";", ",", "") and self.word(i) not in CLOSE:
            i = self.partner[i] + 1 if self.word(i) in OPEN else i + 1
        return i

    def arguments(self, i):
        """Token ranges of the arguments between the parenthesis i and its partner."""
        first, found, k = i + 1, [], i + 1
        while k < self.partner[i]:
            if self.word(k) == ",":
                found.append((first, k))
                first = k + 1
            k = self.partner[k] + 1 if self.word(k) in OPEN else k + 1
        return found + [(first, self.partner[i])]

    def make(self, operator, first, last, new):
        """Replaces tokens first to last - 1 by `new`."""
        return Mutant(self.file, self.tokens[first].start, self.tokens[last - 1].end, new, operator)

    def is_level(self, i):
        open_ = self.partner.get(i + 1, 0)
        return self.word(open_ - 1) in ("texelFetch", "textureSize") and self.word(i - 1) == ","

    def of_number(self, i):
        text = self.word(i)
        if text == "0" and self.word(i + 1) == ")" and self.is_level(i):
            return  # an image without levels has no other level, and fetching from it is undefined
        if re.fullmatch(r"(?:\d+|0[xX][0-9a-fA-F]+)[uU]?", text):
            suffix = text[-1] if text[-1] in "uU" else ""
            yield self.make("constant changed", i, i + 1, f"{int(text.rstrip('uU'), 0) + 1}{suffix}")
            return
        value = float(text.rstrip("fF"))
        if 0 < value < 0.01:
            yield self.make("epsilon removed", i, i + 1, "0.0")
        elif 0 < value < 1e18:
            yield self.make("constant changed", i, i + 1, repr(2 * value))
        elif value == 0:
            yield self.make("constant changed", i, i + 1, "1.0")

    def of_word(self, i):
        text = self.word(i)
        if text in TURNED and self.word(i + 1) == "(":
            yield self.make("comparison turned", i, i + 1, TURNED[text])
        elif text == "if":
            last = self.partner[i + 1]
            leaves = self.word(last + 1) in ("return", "continue", "break") or self.word(last + 1) == "{" and "return" in [t.text for t in self.tokens[last:self.partner[last + 1]]]
            if leaves or self.word(last + 1) != "{":
                yield self.make("guard removed", i + 2, last, "false")
        elif text in ("min", "max", "clamp") and self.word(i + 1) == "(":
            parts = self.arguments(i + 1)
            kept = next((p for p in parts if any(t.kind == "word" for t in self.tokens[p[0]:p[1]])), parts[0])
            yield self.make("clamp removed", i, self.partner[i + 1] + 1, f"({self.between(*kept)})")
        elif self.word(i - 1) == "." and re.fullmatch("[xyzw]{1,4}|[rgba]{1,4}", text) and self.word(i + 1) != "(":
            swapped = text.translate(str.maketrans("xyrg", "yxgr")) if len(text) == 1 else text[::-1]
            if swapped != text:
                yield self.make("axes exchanged", i, i + 1, swapped)

    def of_sign(self, i):
        text = self.word(i)
        if text in TURNED:
            yield self.make("comparison turned", i, i + 1, TURNED[text])
        elif text in ("&&", "||"):
            yield self.make("guard removed", i, self.after_logic(i + 1), "")
        elif text in ("+", "-") and self.is_binary(i):
            yield self.make("sign exchanged", i, i + 1, "-" if text == "+" else "+")
            yield self.make("term dropped", i, self.after_term(i + 1), "")
        elif text in ("*", "/") and self.is_binary(i):
            yield self.make("term dropped", i, self.after_factor(i + 1), "")
        elif text == "?":
            yield from self.of_choice(i)
        elif text == "-":
            yield self.make("sign exchanged", i, i + 1, "")
        elif text in ("+=", "-="):
            yield self.make("sign exchanged", i, i + 1, "-=" if text == "+=" else "+=")

    def of_choice(self, i):
        """Removes a condition and its first alternative: `c ? a : b` becomes `b`."""
        first, colon, depth = i, i + 1, 0
        while self.word(first - 1) not in ("(", "[", "{", ",", ";", "=", "return", "?", ":", "+=", "*="):
            first = self.partner[first - 1] if self.word(first - 1) in CLOSE else first - 1
        while depth or self.word(colon) != ":":
            depth += {"?": 1, ":": -1}.get(self.word(colon), 0)
            colon = self.partner[colon] + 1 if self.word(colon) in OPEN else colon + 1
        yield self.make("guard removed", first, colon + 1, "")

    def mutants(self):
        makers = {"number": self.of_number, "word": self.of_word, "sign": self.of_sign}
        for i, token in enumerate(self.tokens):
            if token.kind in makers:
                yield from (m for m in makers[token.kind](i) if m.new != self.text[m.start:m.end])

    def statement_words(self, at):
        """The words of the statement around a position in the text."""
        i = max(k for k, t in enumerate(self.tokens) if t.start <= at)
        first = last = i
        while first > 0 and self.word(first - 1) not in (";", "{", "}"):
            first -= 1
        while last < len(self.tokens) and self.word(last) not in (";", "{", "}"):
            last += 1
        return {w for t in self.tokens[first:last] for w in re.findall(r"\w+", t.text)}


class Tree:
    """The files of passes/, their includes, and the code that each shader compiles to."""

    def __init__(self, root):
        self.root = pathlib.Path(root)
        paths = sorted(p for kind in ("*.comp", "*.glsl", "*.c") for p in self.root.rglob(kind))
        self.sources = {p.relative_to(root).as_posix(): Source(p.relative_to(root).as_posix(), p.read_text()) for p in paths}
        self.mutable = [f for f in self.sources if f not in LEFT_OUT]
        self.closures = {f: self.closure(f) for f in self.sources if not f.endswith(".glsl")}
        self.codes = {}
        self.generated = tempfile.TemporaryDirectory()  # headers that the build generates from passes/row_kinds.py
        made = [pathlib.Path(self.generated.name) / f for f in ("shared/bindings.glsl", "shared/push_begin.glsl", "glint/row_kinds.h")]
        for path in made:
            path.parent.mkdir(exist_ok=True)
        subprocess.run([sys.executable, self.root / "table.py", "rows", *made], check=True)

    def closure(self, file):
        found, left = set(), [file]
        while left:
            name = left.pop()
            if name in found or name not in self.sources:
                continue
            found.add(name)
            for other in re.findall(r'^#include "([^"]+)"', self.sources[name].text, re.M):
                beside = (pathlib.PurePosixPath(name).parent / other).as_posix()
                left.append(beside if beside in self.sources else other)
        return found

    def shader(self, slot, variant):
        """The file of a pass of any effect; None if there is no such pass."""
        return next((f for f in self.closures if f.split("/")[-2:] in ([slot, f"{variant}.comp"], [slot, f"{variant}.c"])), None)

    def passes_with(self, file):
        """The passes that include the file."""
        return [p.rsplit(".", 1)[0] for p, files in sorted(self.closures.items(), key=lambda c: (len(c[1]), c[0])) if file in files]

    def digest(self):
        """A hash of everything that the choice of mutants depends on."""
        texts = [f + s.text for f, s in sorted(self.sources.items())] + [pathlib.Path(p).read_text() for p in (__file__, mechanism_rows.__file__)]
        return hashlib.sha256("".join(texts).encode()).hexdigest()[:16]

    def changed(self, mutant):
        text = self.sources[mutant.file].text
        return text[:mutant.start] + mutant.new + text[mutant.end:]

    def compile(self, folder, name):
        """A shader's code without unused functions, or None if it does not compile."""
        with tempfile.TemporaryDirectory() as out:
            spirv, plain = f"{out}/a.spv", f"{out}/b.spv"
            done = subprocess.run(["glslangValidator", "--quiet", "--target-env", "vulkan1.3", f"-I{folder}", f"-I{self.generated.name}", "-o", spirv, f"{folder}/{name}.comp"],
                                  capture_output=True)
            if done.returncode:
                return None
            subprocess.run(["spirv-opt", "--strip-debug", "--eliminate-dead-functions", "--eliminate-dead-const", "--compact-ids", spirv, "-o", plain], check=True)
            return pathlib.Path(plain).read_bytes()

    def state(self, mutant, folder):
        """"alive", "does not compile" or "same code"; `folder` is a copy of the tree."""
        path = folder / mutant.file
        path.write_text(self.changed(mutant))
        try:
            if mutant.file.endswith(".c"):
                done = subprocess.run(["cc", "-std=c11", "-fsyntax-only", f"-I{folder}/include", f"-I{self.generated.name}", f"-I{self.root}/../capture-format/include",
                                       path], capture_output=True)
                return "does not compile" if done.returncode else "alive"
            for name in self.passes_with(mutant.file):
                code = self.compile(folder, name)
                if code is None:
                    return "does not compile"
                if name not in self.codes:
                    self.codes[name] = self.compile(self.root, name)
                if code != self.codes[name]:
                    return "alive"
            return "same code"
        finally:
            path.write_text(self.sources[mutant.file].text)


def varied(mutants, name):
    """An order that alternates between the operators."""
    rng = random.Random(f"{SEED} {name}")
    by = {o: [] for o in OPERATORS}
    for m in mutants:
        by[m.operator].append(m)
    for list_ in by.values():
        rng.shuffle(list_)
    order = [o for o in OPERATORS if by[o]]
    rng.shuffle(order)
    return [by[o][n] for n in range(max(map(len, by.values()), default=0)) for o in order if n < len(by[o])]


def name_of(row):
    return f"{row[0]}: {row[1]}"


def mechanism_places(tree):
    """{mechanism: [(files, words)]}: a mechanism is implemented by the statements in these files that contain one of the words, or by all
    statements if there are no words. Where such statements offer no mutant, the words include the variables computed from them."""
    places = collections.defaultdict(list)
    for row in mechanism_rows.ROWS:
        both, off = row[3], row[4]
        slots = preset("mafia3")["slots"]
        slots.update(w.split("=") for s in both for w in re.findall(r"use (\S+=\S+)", s))
        for slot in re.findall(r"use (\w+)=", off):
            shader = tree.shader(slot, slots.get(slot))
            places[name_of(row)].append(({f for f in tree.closures.get(shader, ()) if f.split("/")[-2] == slot}, None))
        for slot, parameter in re.findall(r"set (\w+)\.(\w+)=", off):
            places[name_of(row)].append((tree.closures[tree.shader(slot, slots[slot])], {parameter}))
    for mechanism, where in places.items():
        if not any(is_in(tree, m, where) for files, _ in where for f in files for m in tree.sources[f].mutants()):
            places[mechanism] = [(files, words.union(*(made_from(tree.sources[f], w) for f in files for w in words))) for files, words in where]
    return places


def made_from(source, word):
    """Variables that are assigned by statements with the word."""
    found, since = set(), 0
    for i, token in enumerate(source.tokens):
        if token.text in (";", "{", "}"):
            words = {w for t in source.tokens[since:i] for w in re.findall(r"\w+", t.text)}
            found |= {source.word(k - 1) for k in range(since + 1, i) if word in words and source.word(k) == "="}
            since = i + 1
    return found


def is_in(tree, mutant, places):
    return any(mutant.file in files and (words is None or words & tree.sources[mutant.file].statement_words(mutant.start))
               for files, words in places)


def choose(root, progress, is_known):
    """Mutants with their mechanisms, and the number of rejected ones by state. Those for which is_known() holds compiled before."""
    tree = Tree(root)
    rejected, chosen, made = collections.Counter(), [], {}
    places = mechanism_places(tree)

    def take(candidates, wanted):
        for mutant in candidates:
            if wanted <= 0:
                return
            if mutant in made:
                continue
            made[mutant] = "alive" if is_known(tree.sources[mutant.file], mutant) else tree.state(mutant, folder)
            if made[mutant] == "alive":
                chosen.append(mutant)
                wanted -= 1
            else:
                rejected[made[mutant]] += 1

    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place) / "passes"
        shutil.copytree(root, folder)
        for n, file in enumerate(tree.mutable):
            candidates = varied(list(tree.sources[file].mutants()), file)
            take(candidates, min(max(FEWEST, round(SHARE * len(candidates))), MOST))
            progress(n + 1, len(tree.mutable) + len(places))
        for n, (mechanism, where) in enumerate(sorted(places.items())):
            if not any(is_in(tree, m, where) for m in chosen):
                files = set().union(*(f for f, _ in where))
                take(varied([m for f in sorted(files) for m in tree.sources[f].mutants() if is_in(tree, m, where)], mechanism), 1)
            progress(len(tree.mutable) + n + 1, len(tree.mutable) + len(places))
    inside = {m: [k for k, where in places.items() if is_in(tree, m, where)] for m in chosen}
    return tree, chosen, inside, dict(rejected), sorted(places)
