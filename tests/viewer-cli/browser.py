"""A headless Chromium, driven over a pipe by the DevTools protocol."""
import base64
import contextlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile

import tap  # puts tests/ on the path
import programs


class Browser:
    """One page. `messages`: what it said on the console and which errors there were; `requests`: what it asked for."""

    def __init__(self, width=1280, height=900):
        program = programs.find("chromium-headless-shell", "chromium")
        self.folder = tempfile.mkdtemp(prefix="glint-browser-")
        self.messages, self.requests, self.dialogs = [], [], []
        self.number = 0
        to_read, self.to = os.pipe()
        self.come, from_write = os.pipe()

        def hand_over():
            # above the places first, so that neither is overwritten
            a, b = os.dup(to_read), os.dup(from_write)
            os.dup2(a, 3)
            os.dup2(b, 4)

        self.process = subprocess.Popen(
            [program, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars",
             "--no-first-run", "--disable-background-networking", "--remote-debugging-pipe",
             f"--user-data-dir={self.folder}", f"--window-size={width},{height}", "about:blank"],
            preexec_fn=hand_over, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_read)
        os.close(from_write)
        self.buffer = b""
        self.session = None
        (page,) = (t for t in self.call("Target.getTargets")["targetInfos"] if t["type"] == "page")
        self.session = self.call("Target.attachToTarget", targetId=page["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def receive(self):
        while b"\0" not in self.buffer:
            piece = os.read(self.come, 1 << 20)
            if not piece:
                raise EOFError("the browser is gone")
            self.buffer += piece
        text, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(text)

    def notice(self, event):
        what, values = event.get("method"), event.get("params", {})
        if what == "Runtime.consoleAPICalled":
            self.messages.append(" ".join(str(a.get("value", a.get("description"))) for a in values["args"]))
        elif what == "Runtime.exceptionThrown":
            self.messages.append(json.dumps(values["exceptionDetails"]))
        elif what == "Log.entryAdded":
            self.messages.append(values["entry"]["text"])
        elif what == "Network.requestWillBeSent":
            self.requests.append(values["request"]["url"])
        elif what == "Page.javascriptDialogOpening":
            self.dialogs.append(values["message"])
            self.send("Page.handleJavaScriptDialog", accept=True)
        return what

    def send(self, method, **values):
        self.number += 1
        message = {"id": self.number, "method": method, "params": values}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.to, json.dumps(message).encode() + b"\0")
        return self.number

    def call(self, method, **values):
        number = self.send(method, **values)
        while True:
            answer = self.receive()
            if answer.get("id") == number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self.notice(answer)

    @contextlib.contextmanager
    def another_page(self):
        """A second page of the same browser, which is spoken to until the end of the block."""
        first, self.session = self.session, None
        page = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=page, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime"):
            self.call(f"{domain}.enable")
        try:
            yield
        finally:
            self.session = None
            self.call("Target.closeTarget", targetId=page)
            self.session = first

    def open(self, path):
        for said in (self.messages, self.requests, self.dialogs):
            said.clear()
        self.call("Page.navigate", url=pathlib.Path(os.path.abspath(path)).as_uri())
        while self.notice(self.receive()) != "Page.loadEventFired":
            pass

    def show(self, path):
        """Opens a page of glint report."""
        self.open(path)
        assert self.evaluate("document.documentElement.dataset.ready") == "yes", self.messages

    def quiet(self):
        """Nothing that the page did reached past itself, and nothing complained."""
        outside = [r[:80] for r in self.requests[1:] if not r.startswith("data:image/")]
        assert not self.messages and not outside and not self.dialogs, (self.messages, outside, self.dialogs)

    def evaluate(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def mouse(self, kind, x, y, button=None, **more):
        """`button`: the one that is pressed or held; by default none of a moved pointer, and the left one."""
        button = button or ("none" if kind == "mouseMoved" else "left")
        held = {} if kind == "mouseReleased" else {"buttons": {"none": 0, "left": 1, "middle": 4}[button]}
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button=button, clickCount=0 if kind == "mouseMoved" else 1, **held, **more)

    def drag(self, path, button="left"):
        """Presses at the first place, moves over the others, and lets go at the last."""
        self.point_at(*path[0])
        self.settle()
        self.mouse("mousePressed", *path[0], button)
        for place in path[1:]:
            self.mouse("mouseMoved", *place, button)
        self.mouse("mouseReleased", *path[-1], button)
        self.settle()

    def wheel(self, x, y, down, ctrl=False):
        self.call("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=down, modifiers=2 if ctrl else 0)
        self.settle()

    def settle(self):
        """Until what the page changed is drawn: a pointer finds what is on the screen."""
        self.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def point_at(self, x, y):
        self.settle()
        self.mouse("mouseMoved", x, y)

    def click(self, x, y):
        self.point_at(x, y)
        self.settle()
        for kind in ("mousePressed", "mouseReleased"):
            self.mouse(kind, x, y)

    def key(self, name, number=0, ways=("keyDown", "keyUp")):
        """`number`: the key's Windows number, without which the browser's own controls do not know it."""
        for kind in ways:
            self.call("Input.dispatchKeyEvent", type=kind, key=name, code=name, windowsVirtualKeyCode=number)

    def look(self, dark):
        self.call("Emulation.setEmulatedMedia",
                  features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])

    def screenshot(self, path, whole=False, scale=1):
        """Of the window; a smaller one by `scale`. A press that is held stays one unless the whole page is asked for."""
        clip = {} if scale == 1 else {"clip": {"x": 0, "y": 0, "width": self.evaluate("innerWidth"), "height": self.evaluate("innerHeight"), "scale": scale}}
        data = self.call("Page.captureScreenshot", captureBeyondViewport=whole, **clip)["data"]
        with open(path, "wb") as file:
            file.write(base64.b64decode(data))

    def picture(self, path, width, height):
        """The upper left part of what is scrolled to, also below the window, as PNG or JPEG by the file's name."""
        kind = {"format": "jpeg", "quality": 82} if path.endswith(".jpg") else {"format": "png"}
        data = self.call("Page.captureScreenshot", clip={"x": self.evaluate("scrollX"), "y": self.evaluate("scrollY"), "width": width, "height": height, "scale": 1},
                         captureBeyondViewport=True, **kind)["data"]
        with open(path, "wb") as file:
            file.write(base64.b64decode(data))

    def close(self):
        self.process.kill()
        self.process.wait()
        os.close(self.to)
        os.close(self.come)
        shutil.rmtree(self.folder, ignore_errors=True)


def add_script(path, script):
    """Puts a script at the end of a page, and lets it run."""
    with open(path, encoding="utf-8") as file:
        text = re.sub(r"script-src [^;]*", "script-src 'unsafe-inline'", file.read(), count=1)
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"<script>{script}</script></body>".join(text.rsplit("</body>", 1)))


def run_tests(tests, name):
    """Runs the tests of a class, which it makes with a folder and a browser. The exit status."""
    try:
        with tempfile.TemporaryDirectory(prefix=name) as folder, Browser() as browser:
            return tap.run(tests(folder, browser))
    except programs.Missing as missing:
        print(f"Bail out! {missing}")
        return 1
