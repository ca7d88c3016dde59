"""Neither replay/ nor study/ names an effect, a slot, a variant or an image: what they look for is declared as a row ROLE, or in the rows of
an effect.h, and found by kind.
Fails on every such name there, in strings and in identifiers. A name of several words, such as screen_trace, counts wherever it stands, in
"screen_trace.steps" and in SCREEN_TRACE_STEPS, too. A name of one word is often an English word: it counts where it is a whole string, and a slot's
or an effect's also in "blur=plus" and has_blur. What is exempt is listed below, and the list only shrinks."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Words with another meaning in these files.
EXCEPTIONS = {}
# Slots and effects whose names are also what replay/ calls things of its own: the survey, layers of a capture, its fog and sky, dispatches, the picture, lights. In identifiers, includes
# and keys of run.json they are that; in any other string they are the slots and effects.
OWN_WORDS = {"survey", "planar", "water", "indirect", "shadow", "fog", "picture", "exposure", "display", "light", "lights", "sky"}
# Roles and size classes, some of which are called after images.
DECLARED = re.compile(r"^GLINT_(ROLE|SIZE)_[A-Z_]+$")
# JSON keys are the terms of run.json. These calls take literal keys; the argument of json_string is a value.
KEYED = re.compile(r"\bjson_(?:object_\w+|pack)\s*\(")
STRING = re.compile(r'"((?:[^"\\\n]|\\.)*)"')


def registry():
    """Every name that the passes declare, and which of them are slots or effects."""
    names, slots = set(), set()
    for path in (ROOT / "passes").rglob("*.pass.h"):
        slot, variant = path.parent.name, path.name.removesuffix(".pass.h")
        names |= {slot, variant, f"{slot}/{variant}"}
        slots.add(slot)
    effects = {path.parent.name for path in (ROOT / "passes").glob("*/effect.h")}
    names |= effects
    slots |= effects
    for path in (ROOT / "passes").rglob("*.h"):
        text = path.read_text(encoding="utf-8")
        names.update(re.findall(r"^(?:WRITE|DIAGNOSTIC)\(\w+,\s*(\w+),", text, re.M))
        names.update(re.findall(r"^CAPTURE\((\w+),", text, re.M))
    return names, slots


def without_keys(text):
    """The text without the arguments of calls that take keys."""
    out, at = "", 0
    for call in KEYED.finditer(text):
        if call.start() < at:
            continue
        end, depth = call.end(), 1
        while depth and end < len(text):
            depth += {"(": 1, ")": -1}.get(text[end], 0)
            end += 1
        out += text[at:call.end()] + re.sub(r'"[^"\n]*"', lambda s: " " * len(s[0]), text[call.end():end])
        at = end
    return out + text[at:]


def matches(text, names, slots, where, used):
    """Where a file without comments holds a name: (position, what stands there)."""
    several = re.compile(r"(?<![a-z])(?:" + "|".join(sorted((n for n in names if "_" in n), key=len, reverse=True)) + r")(?![a-z])", re.I)
    assigned = re.compile(r"(?:" + "|".join(sorted(slots)) + r")(?:[=./].*)?")
    for literal in STRING.finditer(text):
        own = literal[1] in OWN_WORDS or text.endswith("#include ", 0, literal.start()) and re.match(r"\w+", literal[1])[0] in OWN_WORDS
        if several.search(literal[1]) or assigned.fullmatch(literal[1]) and not own:
            yield literal.start(), literal[0]
    for literal in STRING.finditer(without_keys(text)):
        if literal[1] in EXCEPTIONS.get(where, {}):
            used.add((where, literal[1]))
        elif literal[1] in OWN_WORDS or literal[1] in names and "_" not in literal[1] and not assigned.fullmatch(literal[1]):
            yield literal.start(), literal[0]
    for word in re.finditer(r"\b[A-Za-z_]\w*", STRING.sub(lambda s: " " * len(s[0]), text)):
        if not DECLARED.match(word[0]) and (several.search(word[0]) or (slots - OWN_WORDS) & set(word[0].lower().split("_"))):
            yield word.start(), word[0]


def main():
    names, slots = registry()
    if len(names) < 150 or len(slots) < 20:
        sys.exit(f"only {len(names)} names and {len(slots)} slots found in passes/, expected the whole registry")
    faults, used = [], set()
    for path in sorted(p for folder in ("replay", "study") for kind in ("*.[ch]", "*.cc") for p in (ROOT / folder).rglob(kind)):
        text = re.sub(r"/\*.*?\*/", lambda c: re.sub(r"[^\n]", " ", c[0]), path.read_text(encoding="utf-8"), flags=re.S)
        where = path.relative_to(ROOT).as_posix()
        for start, found in matches(text, names, slots, where, used):
            line = text.count("\n", 0, start) + 1
            faults.append(f"{where}:{line}: {found} is a name of the passes; expected a row ROLE, and its kind here")
    faults += [f"tests/check_names.py: {where} names {word} no more: take the exception out"
               for where, words in EXCEPTIONS.items() for word in sorted(words) if (where, word) not in used]
    print("\n".join(faults), file=sys.stderr)
    sys.exit(1 if faults else 0)


main()
