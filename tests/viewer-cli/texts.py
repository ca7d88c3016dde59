"""Texts of strangers are data: texts.py GLINT. Names of files, parts, channels, classes, passes, presets, keys of manifests, messages of compilers: whatever stands in them, no
control character, no line and no markup of theirs reaches a terminal, a page, a drawing, JSON, CSV or a command line that is printed for copying. Speaks TAP."""
import csv
import json
import os
import struct
import subprocess
import sys
import xml.dom.minidom

import tap
from browser import run_tests
from corpus import CORPUS, MARK, SCRIPT_END, hidden
from live import Live
from terminal_codes import without_codes

GLINT = os.path.abspath(sys.argv[1])


def shown(data, *about):
    """The text that was printed, of which nothing is a stranger's doing."""
    text = data.decode()  # which says that it is UTF-8
    assert not hidden(text), (*about, hidden(text)[:5], text[:600])
    assert not [line for line in text.split("\n") if line.lstrip().startswith(MARK)], (*about, [line[:300] for line in text.split("\n") if MARK in line][:4])
    return text


class Ran:
    def __init__(self, words, folder, statuses):
        run = subprocess.run([GLINT, *words], capture_output=True, cwd=folder, env={**os.environ, "PWNED": os.path.join(folder, "pwned")})
        assert run.returncode in statuses, (words, run.returncode, run.stdout[-600:], run.stderr[-600:])
        self.status, self.out, self.err = run.returncode, shown(run.stdout, words), shown(run.stderr, words)


def attribute(name, kind, value):
    return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value


def picture(path, part, channel, text):
    """An EXR file of one texel, with these names."""
    head = b"v/1\x01" + struct.pack("<i", 2)
    head += attribute(b"channels", b"chlist", channel + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) + b"\0")
    head += attribute(b"compression", b"compression", b"\0") + attribute(b"dataWindow", b"box2i", bytes(16)) + attribute(b"displayWindow", b"box2i", bytes(16))
    head += attribute(b"lineOrder", b"lineOrder", b"\0") + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
    head += attribute(b"screenWindowCenter", b"v2f", bytes(8)) + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1))
    head += attribute(b"name", b"string", part) + attribute(b"comments", b"string", text) + attribute(part[:30] or b"x", b"string", text) + b"\0"
    with open(path, "wb") as file:
        file.write(head + struct.pack("<Q", len(head) + 8) + struct.pack("<iif", 0, 4, 0.5))


def replaced(value, key, text):
    """The document with every text under this key replaced."""
    if isinstance(value, dict):
        return {k: text if k == key and isinstance(v, str) else replaced(v, key, text) for k, v in value.items()}
    return [text if key == "[]" and isinstance(v, str) else replaced(v, key, text) for v in value] if isinstance(value, list) else value


def keys_of_texts(value):
    if isinstance(value, dict):
        return {k for k, v in value.items() if isinstance(v, str)}.union(*map(keys_of_texts, value.values()))
    return {"[]" for v in value if isinstance(v, str)}.union(*map(keys_of_texts, value)) if isinstance(value, list) else set()


class Tests:
    def __init__(self, folder, browser):
        self.folder, self.browser = folder, browser
        self.glint("sample", "street", "-o", "s.exr", "--size", "16x12", "--cube-size", "4", "--light", "1")
        self.glint("replay", "s.exr", "-o", "run", "--preset", tap.PLAIN)

    def path(self, name):
        return os.path.join(self.folder, name)

    def glint(self, *words, statuses=(0,)):
        return Ran(words, self.folder, statuses)

    def linked(self, name, of="s.exr"):
        if not os.path.exists(self.path(name)):
            os.link(self.path(of), self.path(name))
        return name if name[0] != "-" else "./" + name

    def page(self, path, *expected):
        """A page on which no script ran but its own, and which asked for nothing."""
        self.browser.show(self.path(path))
        self.browser.quiet()
        assert self.browser.evaluate("document.querySelectorAll('[onerror],[onload],img[src=x],iframe,object,a[href^=javascript]').length") == 0, path
        text = self.browser.evaluate("document.body.textContent + document.title + [...document.querySelectorAll('*')].flatMap(e => e.tagName === 'SCRIPT' ? [] : "
                                     "[...e.attributes].filter(a => !a.value.startsWith('data:')).map(a => a.value)).join('')")
        scripts = "".join(self.browser.evaluate("[...document.scripts].map(s => s.textContent)"))
        assert not hidden(text.replace(scripts, "").replace("\t", "")), (path, hidden(text.replace(scripts, "")))
        with open(self.path(path), "rb") as file:
            for line in file.read().split(b"<script")[1].split(b"\n")[:1]:  # the document
                assert not hidden(line.decode()), path
        for piece in expected:
            assert piece in text, (path, piece)

    def test_names_of_files(self):
        for name, text in CORPUS.items():
            path = self.linked(f"{text}.exr")
            for words in (["info"], ["validate"], ["lint"], ["info", "--json"]):
                statuses = (0, 1, 2) if name == "bytes" else (0, 1)
                ran = self.glint(*words, path, statuses=statuses)
                if words[-1] == "--json" and ran.status == 0:
                    json.loads(ran.out)
            assert "a\\x1b[31mb" in ran.err + self.glint("info", path).out or name != "escape"
            self.glint("view", path, "--part", text, "-o", "x.png", statuses=(2,))
            self.glint("info", f"{text}/no", statuses=(1, 2))
            self.glint(text, statuses=(2,))
            self.glint("view", f"--{text}", statuses=(0, 2))
        self.glint("replay", self.linked(f"{CORPUS['bytes']}.exr"), "-o", "unnamed", "--preset", tap.PLAIN)
        with open(self.path("unnamed/run.json"), encoding="utf-8") as file:
            assert json.load(file)["capture"]["path"] is None  # JSON has no such text
        self.glint("info", "unnamed")
        self.glint("report", "unnamed", "-o", "u.html")
        assert "not UTF-8" in self.glint("explain", "unnamed", "8,6", "-o", "u2.html", statuses=(1,)).err

    def test_names_in_pictures(self):
        for name, text in CORPUS.items():
            data = text.encode(errors="surrogateescape")
            picture(self.path("p.exr"), data, data[:200], (text + "</script>").encode(errors="surrogateescape"))
            self.glint("info", "p.exr", statuses=(0, 1))
            ran = self.glint("info", "p.exr", "--json", statuses=(0, 1))
            if ran.status == 0:
                json.loads(ran.out)
            self.glint("info", "p.exr", "--headers", statuses=(0, 1))
            self.glint("view", "p.exr", "-o", "p.png", "--overwrite", statuses=(0, 1, 2))
            self.glint("view", "p.exr", "--statistics", statuses=(0, 1, 2))
            self.glint("diff", "p.exr", "s.exr", "--html", "d.html", "--overwrite", statuses=(0, 1, 2, 3, 4, 5))
            offered = subprocess.run([GLINT, "--complete", "view", self.path("p.exr") + ":"], capture_output=True, check=True).stdout
            assert not hidden(offered.decode().replace("\t", "")), (name, offered)

    def test_classes_of_a_capture(self):
        for text in CORPUS.values():
            self.glint("set", "s.exr", f"stencilClasses=1/1={text}", "-o", "c.exr", "--overwrite", statuses=(0, 1, 2))
            if os.path.exists(self.path("c.exr")):
                for words in (["info"], ["validate"], ["lint"], ["set", "--list"]):
                    self.glint(*words, *(["c.exr"] if "--list" not in words else []), statuses=(0, 1))

    def test_texts_of_a_run(self):
        with open(self.path("run/run.json"), encoding="utf-8") as file:
            whole = json.load(file)
        kept = 0
        for i, key in enumerate(sorted(keys_of_texts(whole))):
            for text in ("".join(t for n, t in CORPUS.items() if n not in ("bytes", "long")) + SCRIPT_END, list(CORPUS.values())[i % 7]):
                with open(self.path("run/run.json"), "w", encoding="utf-8") as file:
                    json.dump(replaced(whole, key, text), file)
                ran = self.glint("info", "run", statuses=(0, 1))
                self.glint("info", "run", "--json", statuses=(0, 1))
                kept += ran.status == 0
                if ran.status == 0 and len(text) > 200:
                    self.glint("report", "run", "-o", "r.html", "--overwrite", statuses=(0, 1, 2))
                    self.glint("diff", "run", "run", statuses=(0, 1, 2, 3, 4, 5))
        everything = whole
        for key in ("title", "meaning", "unit", "reason", "name", "driver", "help", "path", "tool"):
            changed = replaced(everything, key, SCRIPT_END)
            with open(self.path("run/run.json"), "w", encoding="utf-8") as file:
                json.dump(changed, file)
            everything = changed if self.glint("report", "run", "-o", "r.html", "--overwrite", statuses=(0, 1, 2)).status == 0 else everything
        with open(self.path("run/run.json"), "w", encoding="utf-8") as file:
            json.dump(everything, file)
        assert kept > 8 and everything != whole
        self.glint("report", "run", "-o", "r.html", "--overwrite")
        self.page("r.html", "</script><script>alert(3)")
        self.glint("diff", "run", "run", "--html", "d.html", "--overwrite", statuses=(0, 1, 2, 3, 4, 5))
        self.page("d.html")
        with open(self.path("run/run.json"), "w", encoding="utf-8") as file:
            json.dump(whole, file)

    def test_presets_and_their_tables(self):
        with open(tap.PLAIN, encoding="utf-8") as file:
            preset = json.load(file)
        names = []
        for name in ("formats", "escape", "markup"):
            names.append(f"./={CORPUS[name][:100]}.json")
            with open(self.path(names[-1]), "w", encoding="utf-8") as file:
                json.dump({**preset, "name": CORPUS[name], "title": CORPUS["lines"] + SCRIPT_END}, file)
            self.glint("plan", "s.exr", "-p", names[-1], statuses=(0, 1, 2))
            with open(self.path("wrong.json"), "w", encoding="utf-8") as file:
                json.dump({**preset, "slots": {CORPUS[name]: "x", "screen_trace": CORPUS["lines"]}, CORPUS["bidi"]: 1}, file)
            self.glint("plan", "s.exr", "-p", "./wrong.json", statuses=(1, 2))
            self.glint("replay", "s.exr", "-o", "x", "--set", CORPUS[name], "--use", CORPUS["lines"], statuses=(1, 2))
        self.glint("compare", "s.exr", "--presets", f"{names[0]},{names[1]}", "-o", "both")
        with open(self.path("both/table.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.reader(file))
        assert len({len(r) for r in rows}) == 1 and len(rows) > 2 and not [c for r in rows for c in r if c[:1] in tuple("=@\t\r")], rows
        self.page("both/index.html")

    def test_messages_of_compilers_and_manifests(self):
        for text in (CORPUS["escape"], CORPUS["bidi"], CORPUS["bytes"], CORPUS["markup"], SCRIPT_END[:-1]):
            with open(self.path("x.comp"), "wb") as file:
                file.write(b"#version 460\n#error " + text.encode(errors="surrogateescape") + b"\nvoid main() { " + text.encode(errors="surrogateescape") + b"; }\n")
            self.glint("replay", "s.exr", "-o", "x", "--preset", tap.PLAIN, "--shader", "resolve=x.comp", statuses=(1, 2))
            with open(self.path("m.json"), "w", encoding="utf-8", errors="surrogateescape") as file:
                json.dump({"glint": 1, text: text, "gbuffer": {text: f"{text}.png", "normal": {"file": f"{text}.exr"}}}, file, ensure_ascii=False)
            self.glint("pack", "m.json", "-o", "m.exr", statuses=(1, 2))
            self.glint("pack", "m.json", "--explain", statuses=(1, 2))

    def test_a_printed_command_line_is_these_words(self):
        for name in ("shell", "lines", "escape", "bidi", "dash", "markup"):
            path = self.linked(f"{name} {CORPUS[name]}.exr") if name != "dash" else self.linked(f"{CORPUS[name]}.exr")
            with Live(GLINT, path, "--preset", tap.PLAIN, cwd=self.folder) as live:
                command = live.post("pipeline", state={})["command"]
            assert not hidden(command) and "\n" not in command, command
            words = subprocess.run(["bash", "-c", f"glint() {{ printf '%s\\0' \"$@\"; }}; {command}"], capture_output=True, check=True, cwd=self.folder,
                                   env={**os.environ, "PWNED": self.path("pwned")}).stdout.split(b"\0")
            assert os.fsencode(path) in words, (path, words)
            assert not os.path.exists(self.path("pwned"))

    def test_in_a_terminal(self):
        for name in ("escape", "lines", "bidi"):
            path = self.linked(f"t{CORPUS[name]}.exr")
            for words in (["info", path], ["info", path + "x"], ["view", path, "--terminal"], ["replay", path, "-p", tap.PLAIN]):
                text = without_codes([GLINT, *words], self.folder)
                assert not hidden(text), (words, hidden(text), text[-500:])

    def test_drawings(self):
        path = self.linked(f"{CORPUS['markup'][:60]}.exr")
        self.glint("replay", path, "-o", "drawn", "--preset", tap.PLAIN)
        self.glint("probe", path, "8,6", "--preset", tap.PLAIN, "-o", "probe.svg")
        drawing = xml.dom.minidom.parse(self.path("probe.svg"))
        assert not [e for e in drawing.getElementsByTagName("*") if e.tagName in ("script", "img", "foreignObject") or any(a.startswith("on") for a in e.attributes.keys())]
        self.glint("explain", "drawn", "8,6", "-o", "e.html")
        self.page("e.html")


sys.exit(run_tests(Tests, "glint-texts-"))
