"""The moving picture of glint live in README.md: a first visit to the page, in headless Chromium over the real server.

live_picture.py GLINT [FOLDER]: writes live.webp, by default to docs/. Pauses in which something replays are left out; what is said at the lower edge
and the pointer are drawn into the page by this script. img2webp (Debian's package webp) puts the frames together."""
import json
import os
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "../tests/viewer-cli"))
from browser import Browser  # noqa: E402
from live import Live  # noqa: E402

WIDTH, HEIGHT, SCALE = 1400, 860, 0.68
STEP_MS = 60  # of a moved pointer
PARAMETER, PLACES = "screen_trace.cells", 8  # what is dragged, and where the drag stops on its way to the left
PIXEL = (0.745, 0.72)  # of the picture: a reflection that the cells decide about
OVERLAY = """(() => {
    const svg = (name, values) => { const e = document.createElementNS('http://www.w3.org/2000/svg', name); for (const k in values) e.setAttribute(k, values[k]); return e; };
    const pointer = svg('svg', {width: 40, height: 40, viewBox: '-10 -10 40 40', id: 'film-pointer'});
    pointer.append(svg('circle', {r: 9, fill: 'none', stroke: '#ffd75e', 'stroke-width': 3, visibility: 'hidden'}),
        svg('path', {d: 'M0,0 V17 L4,13.5 L6.6,19.5 L9.4,18.3 L6.8,12.4 H12 Z', fill: '#fff', stroke: '#000', 'stroke-width': 1.2}));
    const says = document.createElement('div');
    says.id = 'film-says';
    pointer.style.cssText = 'position:fixed;left:0;top:0;z-index:99999;pointer-events:none;overflow:visible';
    says.style.cssText = 'position:fixed;left:0;right:0;bottom:0;z-index:99998;pointer-events:none;background:#ffd75e;color:#111;font:bold 23px/44px sans-serif;text-align:center';
    document.documentElement.append(says, pointer);
})()"""


class Film:
    """Frames of a page, each with the time for which it is shown."""

    def __init__(self, browser, folder):
        self.browser, self.folder, self.frames, self.at = browser, folder, [], [WIDTH / 2, HEIGHT / 2]

    def ask(self, expression):
        return self.browser.evaluate(expression)

    def until(self, expression, seconds=60):
        end = time.monotonic() + seconds
        while not self.ask(expression):
            if time.monotonic() > end:
                sys.exit(f"live_picture: not within {seconds} s: {expression}")
            time.sleep(0.05)

    def quiet(self):
        """Until nothing replays or is measured any more, and the page stays as it is."""
        text, since, end = None, 0, time.monotonic() + 300
        while time.monotonic() - since < 0.9 or not self.ask("!glintLive.shown.busy() && !glintLive.shown.result.draft"):
            now = self.ask("document.body.innerText + [...document.querySelectorAll('[aria-busy]')].map(e => e.getAttribute('aria-busy'))")
            if now != text or "true" in now[-40:]:
                text, since = now, time.monotonic()
            if time.monotonic() > end:
                sys.exit("live_picture: the page does not come to rest")
            time.sleep(0.05)

    def say(self, text):
        self.ask(f"document.getElementById('film-says').textContent = {json.dumps(text)}")

    def shot(self, ms, pressed=False):
        x, y = self.at
        self.ask(f"(p => {{ p.style.transform = 'translate({x - 10}px, {y - 10}px)'; p.firstChild.setAttribute('visibility', '{'visible' if pressed else 'hidden'}'); }})"
                 "(document.getElementById('film-pointer'))")
        self.browser.settle()
        path = os.path.join(self.folder, f"{len(self.frames):03}.png")
        self.browser.screenshot(path, scale=SCALE)
        self.frames.append((path, ms))

    def move(self, x, y, steps=6):
        """Moves the pointer there, slower towards the end."""
        start = list(self.at)
        for i in range(1, steps + 1):
            part = 1 - (1 - i / steps) ** 2
            self.at = [a + (b - a) * part for a, b in zip(start, (x, y))]
            self.browser.mouse("mouseMoved", *self.at)
            self.shot(STEP_MS)

    def place(self, element, x=0.5, y=0.5):
        """A place in an element, by parts of its width and height."""
        left, top, width, height = self.ask(f"(r => [r.x, r.y, r.width, r.height])(({element}).getBoundingClientRect())")
        return left + x * width, top + y * height

    def press(self, kind="mousePressed"):
        self.browser.mouse(kind, *self.at)

    def drag(self, x, y):
        """Moves the pressed pointer there."""
        self.at = [x, y]
        self.browser.mouse("mouseMoved", x, y, "left")

    def click(self, *place):
        self.move(*place)
        self.press()
        self.press("mouseReleased")
        self.shot(350, pressed=True)

    def write(self, path):
        words = [word for frame, ms in self.frames for word in ("-d", str(ms), frame)]
        subprocess.run(["img2webp", "-loop", "0", "-min_size", "-lossy", "-q", "75", "-m", "6", *words, "-o", path], check=True, capture_output=True)
        print(f"{path}: {len(self.frames)} frames, {sum(ms for _, ms in self.frames) / 1000:.1f} s, {os.path.getsize(path) / 1e6:.2f} MB")


def open_page(film, address):
    film.browser.look(dark=True)
    film.browser.call("Page.navigate", url=address)
    film.until("document.documentElement?.dataset.ready === 'yes' && !!glintLive.shown?.result && !!document.querySelector('.frame canvas')")
    # on slow machines the page measures by itself only if it is told to
    film.ask("(b => { if (!b.checked) b.click(); })([...document.querySelectorAll('#figures label')].find(l => l.textContent.includes('after each change')).querySelector('input'))")
    film.ask(OVERLAY)
    film.quiet()


def drag_parameter(film):
    film.say("A slider is dragged: the frame replays, from the pass that it belongs to")
    slider = f"document.querySelector('[data-name=\"{PARAMETER}\"] input[type=range]')"
    part = film.ask(f"(s => s.value / s.max)({slider})")
    film.move(*film.place(slider, 0.04 + 0.92 * part))
    film.press()
    for i in range(1, PLACES + 1):
        film.drag(*film.place(slider, 0.04 + 0.92 * part * (1 - i / PLACES) + 0.06 * i / PLACES))
        film.quiet()
        film.shot(260, pressed=True)
    film.press("mouseReleased")
    film.shot(700)


def pin_preset(film):
    film.say("B: the preset as it was")
    chooser = "document.getElementById('pin')"
    film.click(*film.place(chooser))
    # a list that a browser opens stands outside of the page, and in no picture of it
    film.ask(f"(s => {{ s.value = [...s.options].find(o => o.textContent === glintLive.shown.state.preset).value; s.dispatchEvent(new Event('change')); }})({chooser})")
    film.until("!!glintLive.shown.pinned?.result")
    film.quiet()
    film.shot(700)


def compare(film):
    film.say("A and B under a slider")
    frame = "document.querySelector('.frame')"
    film.move(*film.place(frame, 0.5, 0.75))
    film.press()
    for part in (0.5, 0.54, 0.62, 0.74, 0.86, 0.96, 0.88, 0.76, 0.62, 0.5, 0.4, 0.26, 0.12, 0.04, 0.2, 0.6):
        film.drag(*film.place(frame, part, 0.75))
        film.browser.settle()
        film.shot(110, pressed=True)
    film.press("mouseReleased")
    film.quiet()
    film.shot(500)


def click_pixel(film):
    film.say("A click on a pixel: its ray on screen and through cube maps, and why it ended")
    film.click(*film.place("document.querySelector('.frame')", *PIXEL))
    film.until("!!document.querySelector('.live-pixel[aria-busy=false] img')?.naturalWidth")
    film.quiet()
    film.shot(2200)


def show_points(film):
    film.say("Error and time of all that was tried; a click on a point goes back to it")
    film.ask("document.querySelector('.tried').scrollIntoView({block: 'center'})")
    film.browser.settle()
    film.shot(700)
    x, y, width, height = film.ask("(r => [r.x, r.y, r.width, r.height])(document.querySelector('.tried svg').getBoundingClientRect())")
    film.move(x + width * 0.4, y + height * 0.5)
    film.shot(1800)


def story(film):
    film.say("glint live street.exr")
    film.shot(1300)
    film.say("Which parameter? The search knows their names and help")
    film.click(*film.place("document.getElementById('search')"))
    for letter in PARAMETER.split(".")[1]:
        film.browser.call("Input.insertText", text=letter)
        film.shot(90)
    film.shot(400)
    drag_parameter(film)
    click_pixel(film)
    pin_preset(film)
    compare(film)
    show_points(film)


def main():
    glint = os.path.abspath(sys.argv[1])
    docs = os.path.abspath(sys.argv[2] if len(sys.argv) > 2 else os.path.join(HERE, "../docs"))
    with tempfile.TemporaryDirectory() as folder, Browser(WIDTH, HEIGHT) as browser:
        capture = os.path.join(folder, "street.exr")
        subprocess.run([glint, "sample", "street", "-o", capture, "--size", "480x270", "--cube-size", "64", "--truth", "1"], check=True, capture_output=True)
        film = Film(browser, folder)
        with Live(glint, "street.exr", cwd=folder) as live:
            open_page(film, live.address)
            story(film)
        film.write(os.path.join(docs, "live.webp"))


if __name__ == "__main__":
    main()
