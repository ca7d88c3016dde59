"""glint replay --watch: a shader and a preset are edited, the page follows: watch.py GLINT PASSES. Speaks TAP."""
import json
import os
import queue
import shutil
import signal
import subprocess
import sys
import threading
import time

from browser import run_tests

GLINT, PASSES = sys.argv[1:]
WAIT_S = 60  # for a replay of a tiny capture on a busy machine


class Watched:
    """A replay that watches; its output is read line by line."""

    def __init__(self, *words):
        self.process = subprocess.Popen([GLINT, "replay", *words, "--watch"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.lines = queue.Queue()
        threading.Thread(target=lambda: [self.lines.put(line) for line in self.process.stdout], daemon=True).start()

    def until(self, *words):
        """The next line that contains all of these."""
        seen = []
        while True:
            try:
                seen.append(self.lines.get(timeout=WAIT_S))
            except queue.Empty:
                raise AssertionError((words, seen, self.process.poll())) from None
            if all(word in seen[-1] for word in words):
                return seen[-1]


class Tests:
    def __init__(self, folder, browser):
        self.folder, self.browser = folder, browser
        subprocess.run([GLINT, "sample", "room", "--light=4", "-o", self.path("room.exr"), "--size=48x27", "--cube-size=16"], check=True, capture_output=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        """Like editors: a new file replaces the old one."""
        with open(self.path("new"), "w", encoding="utf-8") as file:
            file.write(text)
        os.rename(self.path("new"), self.path(name))

    def page_says(self, words):
        """Waits until the page contains this after reloading by itself."""
        end = time.monotonic() + WAIT_S
        while time.monotonic() < end:
            try:
                if words in self.browser.evaluate("document.documentElement.dataset.ready === 'yes' ? document.querySelector('main').textContent : ''"):
                    return True
            except RuntimeError:
                pass  # between two pages
            time.sleep(0.2)
        return False

    def test_a_page_follows_what_is_edited(self):
        shutil.copy(os.path.join(PASSES, "picture/compose/brdf.comp"), self.path("my.comp"))
        with open(self.path("my.comp"), encoding="utf-8") as file:
            shader = file.read()
        store = "vec4(color, 1.0)"
        assert store in shader
        with open(os.path.join(os.path.dirname(PASSES), "samples/presets/mafia3.json"), encoding="utf-8") as file:
            preset = json.load(file)
        self.write("mine.json", json.dumps(preset))
        watched = Watched(self.path("room.exr"), "-o", self.path("run"), "--preset", self.path("mine.json"), f"--shader=compose={self.path('my.comp')}")
        try:
            assert "equal to the first" in watched.until("version 1")
            watched.until("watching", "watch.html")
            self.browser.show(self.path("run/watch.html"))
            assert self.page_says("Version 1") and self.browser.evaluate("document.querySelectorAll('.stage').length") == 1

            self.write("my.comp", shader.replace(store, "vec4(storable(2.0 * color, frame.up.w), 1.0)"))
            line = watched.until("version 2")
            assert "1 of" in line and "compose: composed" in line and "1 passes ran" in line, line
            assert self.page_says("Version 2"), self.browser.messages
            rows = self.browser.evaluate("[...document.querySelectorAll('main tbody tr')].map(r => r.textContent)")
            assert any("composed" in row for row in rows), rows
            ratio = json.loads(subprocess.run([GLINT, "diff", self.path("run/first"), self.path("run"), "--json"], capture_output=True, text=True).stdout)
            largest = next(i for i in ratio["images"] if i["name"] == "composed")["largest"]
            assert abs(largest["b"] / largest["a"] - 2) < 2e-3, largest  # each is rounded to half

            self.write("my.comp", shader.replace(store, "vec4(storable(colour, frame.up.w), 1.0)"))
            line = watched.until("version 3 failed")
            assert "my.comp" in line and watched.process.poll() is None, line
            assert self.page_says("Version 3") and self.page_says("this is version 2"), self.browser.messages
            fault = self.browser.evaluate("document.querySelector('pre').textContent")
            assert "colour" in fault and "my.comp" in fault, fault
            assert self.browser.evaluate("document.querySelectorAll('.stage').length") >= 1

            self.write("my.comp", shader)
            assert "equal to the first" in watched.until("version 4")

            preset["set"]["cubemap_trace.steps_hq"] = 2
            self.write("mine.json", json.dumps(preset))
            line = watched.until("version 5")
            assert "cubemap_trace: " in line, line
            assert self.page_says("Version 5") and self.page_says("cubemap_trace.steps_hq")
            self.write("mine.json", "{")
            assert "mine.json" in watched.until("version 6 failed")
            asked = {url for url in self.browser.requests if not url.startswith("data:image/")}
            assert len(asked) == 1 and not self.browser.messages, (asked, self.browser.messages)
        finally:
            watched.process.send_signal(signal.SIGINT)
            status = watched.process.wait(WAIT_S)
        assert status == 0, status
        with open(self.path("run/watch.html"), encoding="utf-8") as file:
            assert '"refresh"' not in file.read()

    def test_what_cannot_be_watched_says_so(self):
        for words in (["--watch"], ["-o", "x", "--watch", self.path("room.exr")], ["-o", "x", "--watch", "--json"]):
            run = subprocess.run([GLINT, "replay", self.path("room.exr"), *words], capture_output=True, text=True)
            assert run.returncode == 2 and "--watch" in run.stderr, run.stderr


sys.exit(run_tests(Tests, "glint-watch-"))
