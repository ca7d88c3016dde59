"""What tests of the page of glint live share: its server, a browser with the page in it, expressions for its parts."""
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

import tap
from browser import Browser
from tap import glint, programs

SIZE = (160, 90)
STORE = "glintLive.shown"
NOISE = "Failed to load resource: "  # what Chromium says of 400 and 409, which the page expects


class Server:
    """glint live over captures, ended by Ctrl-C."""
    def __init__(self, *words):
        self.process = subprocess.Popen([sys.argv[1], "live", *words], stdout=subprocess.PIPE, text=True)
        self.url, _, self.token = self.process.stdout.readline().strip().partition("#")  # a token from a file is not printed

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if self.process.poll() is None and kind:
            self.process.kill()
            self.process.wait()
        elif self.process.poll() is None:
            self.end()

    def end(self):
        self.process.send_signal(signal.SIGINT)
        assert self.process.wait(timeout=20) == 0, self.process.returncode


class Tab:
    """A browser with the page of a server in it."""
    def __init__(self, browser, server):
        self.browser, self.server = browser, server

    def ask(self, expression):
        return self.browser.evaluate(expression)

    def until(self, expression, seconds=20):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            try:
                if value := self.ask(f"(v => v instanceof Node ? true : v)({expression})"):
                    return value
            except RuntimeError:
                pass  # the page is being made
            time.sleep(0.02)
        said = self.ask("[...document.querySelectorAll('[role=status], [role=alert]')].map(e => e.textContent).filter(t => t).join('; ')")
        raise AssertionError(f"not within {seconds} s: {expression}; the page says: {said}; {self.browser.messages}")

    def go(self, fragment=None):
        for list_ in (self.browser.messages, self.browser.requests):
            list_.clear()
        self.browser.call("Page.navigate", url="about:blank")
        self.browser.call("Page.navigate", url=self.server.url + (f"#{self.server.token}" if fragment is None else fragment))
        self.until("document.documentElement.dataset.ready")

    def open(self, fragment=None):
        self.go(fragment)
        self.idle()
        self.ask(f"window.results = []; {STORE}.on('result', s => results.push({{run: s.result.run, draft: s.result.draft, state: s.result.state}})); 1")

    def idle(self):
        """Until the newest state is replayed, whole."""
        self.until(f"typeof glintLive !== 'undefined' && {STORE}?.result && !{STORE}.busy() && document.documentElement.dataset.busy === 'no'")
        self.browser.settle()

    def state(self):
        return json.loads(self.ask(f"JSON.stringify({STORE}.state)"))

    def shown(self):
        """The state of the picture."""
        return json.loads(self.ask(f"JSON.stringify({STORE}.result.state)"))

    def box(self, element):
        self.ask(f"{element}.scrollIntoView({{block: 'center'}})")
        self.browser.settle()
        return self.ask(f"(r => [r.x, r.y, r.width, r.height])({element}.getBoundingClientRect())")

    def click(self, element):
        x, y, w, h = self.box(element)
        self.browser.click(x + w / 2, y + h / 2)

    def press(self, key, number=0, text=None, **modifiers):
        down = {"type": "keyDown", "key": key, "code": key, "windowsVirtualKeyCode": number, **modifiers}
        self.browser.call("Input.dispatchKeyEvent", **down, **({"text": text} if text else {}))
        self.browser.call("Input.dispatchKeyEvent", **{**down, "type": "keyUp"})

    def letter(self, key):
        self.press(key, ord(key.upper()), text=key)

    def write(self, element, text):
        """What somebody types into a field, with Enter; a slot that is folded is opened before."""
        self.ask(f"{element}.closest('.slot')?.querySelector('.fold[aria-expanded=false]')?.click()")
        self.ask(f"{element}.focus(), {element}.select()")
        self.browser.call("Input.insertText", text=text)
        self.press("Enter", 13, text="\r")

    def quiet(self):
        told = [m for m in self.browser.messages if not m.startswith(NOISE)]
        asked = [r for r in self.browser.requests if not r.startswith((self.server.url, "blob:", "data:image/", "about:"))]
        assert not told and not asked and not self.browser.dialogs, (told, asked, self.browser.dialogs)


def row(name):
    return f"document.querySelector('.parameter[data-name=\"{name}\"]')"


def slot(name):
    return f"document.querySelector('.slot[data-slot=\"{name}\"]')"


def button(text, within="document"):
    return f"[...{within}.querySelectorAll('button')].find(b => b.textContent === '{text}')"


class Tests:
    """Over one server with two captures."""
    def __init__(self, folder, browser, server):
        self.folder, self.server = folder, server
        self.tab = Tab(browser, self.server)
        self.ask, self.until, self.idle = self.tab.ask, self.tab.until, self.tab.idle
        self.tab.open()
        self.registry = json.loads(self.ask(f"JSON.stringify({STORE}.registry)"))

    def path(self, name):
        return os.path.join(self.folder, name)

    def reset(self):
        """The page as it is at first."""
        self.tab.open()
        return self.tab

    def parameters(self):
        """Those of the slots in the pipeline: {name: parameter}, in their order."""
        slots = json.loads(self.ask(f"JSON.stringify({STORE}.slots)"))
        chosen = {(s["slot"], s["variant"]) for s in slots}
        return {p["name"]: p for v in self.registry["passes"] if (v["slot"], v["variant"]) in chosen for p in v["parameters"]}

    def integer(self):
        """An integer parameter of a pass that runs, with a range that a drag has places in."""
        ran = {p["slot"] for p in json.loads(self.ask(f"JSON.stringify({STORE}.result.passes)")) if p["ran"] and not p["cached_work"]}
        return next(p for n, p in self.parameters().items() if p["type"] == "int" and n.split(".")[0] in ran and 30 < p["highest"] - p["lowest"] and "steps" in n)


def run(tests):
    """Runs the tests of a class. The exit status."""
    try:
        with tempfile.TemporaryDirectory(prefix="glint-live-") as folder, Browser(1440, 900) as browser:
            captures = []
            for name, words in (("street", ["--truth=1"]), ("room", ["--light=4"])):
                captures.append(os.path.join(folder, f"{name}.exr"))
                glint("sample", name, *words, "-o", captures[-1], f"--size={SIZE[0]}x{SIZE[1]}", "--cube-size=16")
            with Server(*captures, "-o", os.path.join(folder, "runs")) as server:
                return tap.run(tests(folder, browser, server))
    except programs.Missing as missing:
        print(f"Bail out! {missing}")
        return 1
