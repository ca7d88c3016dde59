"""Names of strangers on pages, in headless Chromium: texts_pages.py GLINT [--all]. Names of captures, folders, presets and tags stand on the pages of live, compare, sweep and report
as text: no script of a name runs, and no element or attribute is made by one. With --all each text of the corpus, otherwise what breaks out of markup. Speaks TAP."""
import json
import os
import sys

import tap
from browser import run_tests
from corpus import CORPUS, hidden
from live_tab import Server, Tab
from tap import glint

# Whatever a name would have to break out of: text, attributes with any quotation marks, scripts, styles, comments, templates.
FORGED = "<x-forged>\"data-forged=1 'data-forged=2 `data-forged=3 ${forged()}\\"
OUT = "--></script></style></title><svg onload=forged()><x-forged onclick=forged()>{{forged()}}"
# What is no UTF-8 is no string of JSON, of which pages, sets and presets are.
NAMES = {**{name: text for name, text in CORPUS.items() if name != "bytes"}, "forged": FORGED, "out": OUT.replace("/", "\\")} if "--all" in sys.argv else {"forged": FORGED + CORPUS["markup"][:90]}
EVERY = "[...document.querySelectorAll('*')]"
MADE = f"""{EVERY}.filter(e => e.matches('x-forged, img[src=x], iframe, object, embed, base, a[href^=javascript]') ||
    [...e.attributes].some(a => a.name.startsWith('on') || a.name === 'data-forged')).map(e => e.outerHTML.slice(0, 200))"""
# What a reader gets of the page: its text and its attributes.
TEXT = f"""document.title + {EVERY}.flatMap(e => e.tagName === 'SCRIPT' || e.tagName === 'STYLE' ? [] :
    [...e.childNodes].filter(n => n.nodeType === 3).map(n => n.data).concat([...e.attributes].filter(a => !a.value.startsWith('data:')).map(a => a.value), e.value ?? '')).join(' ')"""


def cut(text, most):
    """The beginning of a text, of so many bytes, whole characters."""
    return text.encode(errors="surrogateescape")[:most].decode(errors="ignore")


class Tests:
    def __init__(self, folder, browser):
        self.folder, self.browser = folder, browser
        os.chdir(folder)
        glint("sample", "still_life", "-o", "s.exr", "--size", "16x9", "--cube-size", "4", "--truth", "1")

    def capture(self, text):
        """A capture with this name."""
        path = f"./{text}.exr"
        if not os.path.exists(path):
            os.link("s.exr", path)
        return path

    def preset(self, text, i):
        with open(tap.PLAIN, encoding="utf-8") as file:
            preset = json.load(file)
        path = f"./p{i}{cut(text, 90)}.json"
        with open(path, "w", encoding="utf-8") as file:
            json.dump({**preset, "name": cut(text, 60), "title": text.encode(errors="replace").decode() + OUT}, file)
        return path

    def set(self, text):
        with open("set.json", "w", encoding="utf-8") as file:
            json.dump({"format": 1, "captures": [{"path": self.capture(text), "tags": [cut(text, 60).encode(errors="replace").decode() or "x", "plain"]}, {"path": "s.exr", "tags": ["plain"]}]}, file)
        return "set.json"

    def look(self, *expected):
        """Nothing is made by a name, no hidden character is shown, and these texts are."""
        made, text = self.browser.evaluate(MADE), self.browser.evaluate(TEXT)
        assert not made, made
        assert not self.browser.dialogs and not [m for m in self.browser.messages if "forged" in m or "Refused" in m or "Content Security" in m], (self.browser.dialogs, self.browser.messages)
        assert not hidden(text.replace("\t", "")), hidden(text.replace("\t", ""))[:5]
        for piece in expected:
            assert piece in text, (piece, text[:3000])

    def plain(self, text):
        """What of a name is shown as it is: its beginning up to what is escaped or wrapped."""
        return text[:next((i for i, c in enumerate(text) if hidden(c) or c in "\n\\"), len(text))].strip()[:30]

    def test_live(self):
        for i, text in enumerate(NAMES.values()):
            with Server(self.capture(text), "s.exr", "-p", self.preset(text, i)) as server:
                tab = Tab(self.browser, server)
                tab.open()
                self.look(self.plain(text))
                tab.ask("glintLive.shown.seek(1)")
                tab.idle()
                tab.write("document.querySelector('.parameter input')", text)
                tab.until("[...document.querySelectorAll('.parameter [aria-invalid=true], [role=alert]')].some(e => !e.hidden)")
                self.look()
                tab.go(f"#{server.token}&s=" + "".join(f"%{b:02x}" for b in json.dumps({"preset": text, "capture": 1, "sets": {text: 1}}).encode(errors="replace")))
                tab.until("[...document.querySelectorAll('[role=alert], [role=status]')].some(e => e.textContent)")
                self.look()

    def test_studies(self):
        for i, text in enumerate(NAMES.values()):
            presets = f"plain.json,{self.preset(text, i)}" if "," not in text else "plain.json,kf2"
            with open(tap.PLAIN, encoding="utf-8") as file, open("plain.json", "w", encoding="utf-8") as copy:
                copy.write(file.read())
            out = f"./o{i}{cut(text, 60)}"
            glint("compare", self.set(text), "--presets", presets, "--repeat", "1", "-o", out)
            self.browser.show(f"{out}/index.html")
            self.look(self.plain(text))
            study = f"./w{i}{cut(text, 60)}"
            glint("sweep", "set.json", "-p", "plain.json", "--vary", "screen_trace.steps=4,8", "--repeat", "0", "--reference", "truth", "-o", study)
            self.browser.show(f"{study}/index.html")
            self.look(self.plain(text))
            run = f"./r{i}{cut(text, 60)}"
            glint("replay", self.capture(text), "-p", "plain.json", "-o", run)
            glint("report", run, "-o", "report.html", "--overwrite")
            self.browser.show("report.html")
            self.look(self.plain(text))


sys.exit(run_tests(Tests, "glint-pages-"))
