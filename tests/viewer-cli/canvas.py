"""A stage whose pictures are pixels that a script replaces, as in the page of glint live, in headless Chromium: canvas.py GLINT. Speaks TAP."""
import json
import os
import sys

from browser import add_script, run_tests
from tap import glint

# Pictures of 40 × 20 pixels whose red is 6 x, and whose green is 12 y; `blue` tells them apart.
SCRIPT = """
let stage, picks = [], changes = [], asked = [], answers = {};
const pixels = (blue, w = 40, h = 20) => {
    const data = new ImageData(w, h);
    for (let i = 0; i < w * h; i++) data.data.set([6 * (i % w) * 40 / w, 12 * Math.floor(i / w) * 20 / h, blue, 255], 4 * i);
    return data;
};
const canvas = blue => {
    const e = document.createElement('canvas');
    Object.assign(e, {width: 40, height: 20});
    e.getContext('2d').putImageData(pixels(blue), 0, 0);
    return e;
};
const picture = (caption, p, more) => ({caption, pixels: p, size: [40, 20], ...more});
const table = (x, y, v) => ({title: `${x},${y}`, channels: ['R'], unit: 'nit', rows: [['A', [String(v)]]]});
const make = (pictures, hooks) => {
    stage = glintStage.stage({title: 'P', pictures}, glintParts.page(), {pick: (x, y) => picks.push([x, y]), change: s => changes.push(s), ...hooks});
    document.querySelector('main').replaceChildren(stage);
};
const both = (a, b) => [picture('A', pixels(a)), picture('B', canvas(b)), picture('Heat', null, {alone: true})];
const $ = s => document.querySelector(s), all = s => [...document.querySelectorAll(s)];
const layers = () => all('.frame .layer').filter(e => !e.hidden && getComputedStyle(e).visibility !== 'hidden');
const colour = (e, x, y) => {
    const copy = document.createElement('canvas').getContext('2d', {willReadFrequently: true});
    copy.drawImage(e, -x, -y);
    return [...copy.getImageData(0, 0, 1, 1).data];
};
"""


class Tests:
    def __init__(self, folder, browser):
        self.browser, self.page = browser, os.path.join(folder, "page.html")
        with open(os.path.join(folder, "page.json"), "w", encoding="utf-8") as file:
            json.dump({"format": 1, "title": "T", "facts": [], "sections": []}, file)
        glint("report", folder, "-o", self.page)
        add_script(self.page, SCRIPT)

    def ask(self, expression):
        return self.browser.evaluate(expression)

    def show(self, pictures="both(10, 200)", hooks="{}"):
        self.browser.show(self.page)
        self.ask(f"make({pictures}, {hooks})")

    def at(self, x, y):
        left, top, wide, high = self.ask("(r => [r.x, r.y, r.width, r.height])($('.frame').getBoundingClientRect())")
        return left + (x + 0.5) / 40 * wide, top + (y + 0.5) / 20 * high

    def press(self, text):
        self.ask(f"all('.stage .bar button').find(b => b.textContent === '{text}').click()")

    def test_pictures_are_their_pixels(self):
        self.show()
        assert self.ask("layers().map(e => [e.tagName, e.width, e.height, e.getAttribute('aria-label')])") == [["CANVAS", 40, 20, "A"], ["CANVAS", 40, 20, "B"]]
        assert self.ask("layers().map(e => colour(e, 3, 7))") == [[18, 84, 10, 255], [18, 84, 200, 255]]
        first, second = self.ask("layers().map(e => (r => [r.x, r.y, r.width, r.height])(e.getBoundingClientRect()))")
        assert first == second == self.ask("(r => [r.x, r.y, r.width, r.height])($('.frame').getBoundingClientRect())") and abs(first[2] - 2 * first[3]) < 1, (first, second)
        self.press("Side by side")
        (x, _, w, h), (x2, _, w2, h2) = self.ask("layers().map(e => (r => [r.x, r.y, r.width, r.height])(e.getBoundingClientRect()))")
        assert abs(x2 - x - w) < 1 and abs(w - 2 * h) < 1 and (w, h) == (w2, h2)
        # what is not there yet is empty, and comes in place
        self.press("Heat")
        assert self.ask("layers().length") == 0
        self.ask("stage.update([...both(1, 2).slice(0, 2), picture('Heat', pixels(99), {alone: true})])")
        assert self.ask("layers().map(e => colour(e, 3, 7)[2])") == [99]
        self.browser.quiet()

    def test_an_update_keeps_what_somebody_chose(self):
        self.show()
        self.ask("stage.set({zoom: 4})")
        self.browser.drag([self.at(20, 5), self.at(11, 5), self.at(9.5, 5)])
        self.ask("all('.stage .bar button')[0].focus(), held = [document.activeElement, ...all('.layer')]")
        before = self.ask("[$('.layer + .layer').style.clipPath, $('.frame').style.width, $('.bar select').value, stage.pointed()]")
        self.ask("stage.update(both(50, 60))")
        assert self.ask("[$('.layer + .layer').style.clipPath, $('.frame').style.width, $('.bar select').value, stage.pointed()]") == before
        assert before[0].startswith("inset(0px 0px 0px 25") and before[1:] == ["320px", "4", [10, 5]], before
        assert self.ask("[document.activeElement, ...all('.layer')].every((e, i) => e === held[i])")
        assert self.ask("layers().map(e => colour(e, 0, 0)[2])") == [50, 60]
        # B goes and comes back: so does the slider, with another name for B
        self.press("Side by side")
        self.ask("stage.update(both(1, 2).slice(0, 1))")
        assert self.ask("layers().length") == 1
        self.ask("stage.update([picture('A', pixels(3)), picture('other', pixels(4))])")
        assert self.ask("layers().map(e => colour(e, 0, 0)[2])") == [3, 4] and self.ask("$('.frame').className") == "frame beside"
        assert self.ask("all('.frame .tag').map(t => t.textContent)") == ["A", "other"]
        self.press("other")
        assert self.ask("layers().map(e => colour(e, 0, 0)[2])") == [4]
        self.browser.quiet()

    def test_a_draft_stands_for_the_whole_picture(self):
        self.show("[picture('A', pixels(10))]")
        box = self.ask("(r => [r.width, r.height])($('.frame').getBoundingClientRect())")
        self.ask("stage.update([picture('A', pixels(10, 20, 10))])")
        assert self.ask("(r => [r.width, r.height])($('.frame').getBoundingClientRect())") == box and self.ask("layers()[0].width") == 20
        self.browser.point_at(*self.at(31, 11))
        assert self.ask("stage.pointed()") == [31, 11]
        self.browser.quiet()

    def test_the_newest_values_stay(self):
        self.show(hooks="{values: (x, y) => new Promise(done => { answers[`${x},${y}`] = v => done(v === null ? null : table(x, y, v)); })}")
        readout = "all('.readout th, .readout td').map(e => e.textContent).join(' ').trim()"
        self.browser.point_at(*self.at(3, 4))
        self.browser.point_at(*self.at(30, 14))
        assert "Point at a pixel" in self.ask("$('.readout').textContent")
        self.ask("answers['30,14'](7)")
        assert self.ask(readout) == "30,14 R nit A 7", self.ask(readout)
        self.ask("answers['3,4'](1)")
        assert self.ask(readout) == "30,14 R nit A 7"
        # other pictures have other values, and nothing to say leaves what was said
        self.ask("delete answers['30,14'], stage.update(both(1, 2))")
        self.ask("answers['30,14'](8)")
        assert self.ask(readout) == "30,14 R nit A 8"
        self.browser.point_at(*self.at(5, 5))
        self.ask("answers['5,5'](null)")
        assert self.ask(readout) == "30,14 R nit A 8"
        self.browser.quiet()

    def test_a_click_picks_and_a_drag_slides(self):
        self.show()
        cut = "$('.layer + .layer').style.clipPath"
        before = self.ask(cut)
        self.browser.click(*self.at(10, 3))
        assert self.ask("picks") == [[10, 3]] and self.ask(cut) == before
        self.browser.drag([self.at(20, 5), self.at(25, 5), self.at(29.5, 5)])
        assert self.ask("picks") == [[10, 3]] and self.ask(cut).startswith("inset(0px 0px 0px 75"), self.ask(cut)
        # nor does one that ends where it began
        self.browser.drag([self.at(20, 5), self.at(25, 5), self.at(20, 5)])
        self.press("A")
        self.browser.drag([self.at(20, 5), self.at(29.5, 5)])
        assert self.ask("picks.length") == 1
        self.ask("$('.frame').focus()")
        self.browser.key("ArrowRight", 39)
        self.browser.key("Enter", 13)
        assert self.ask("picks[1]") == self.ask("stage.pointed()")
        self.ask("stage.mark(7, 8)")
        x, y = self.ask("(r => [r.x + r.width / 2, r.y + r.height / 2])($('.cross.picked').getBoundingClientRect())")
        assert all(abs(a - b) < 1 for a, b in zip((x, y), self.at(7, 8)))
        self.ask("stage.mark(-1, -1)")
        assert self.ask("$('.cross.picked').hidden")
        self.browser.quiet()

    def test_zoom_keeps_the_pixel_under_the_pointer(self):
        self.show()
        size = "[$('.bar select').selectedOptions[0].textContent, $('.frame').getBoundingClientRect().width]"
        place = self.at(31, 12)
        self.browser.point_at(*place)
        _, fit = self.ask(size)
        seen = []
        for _ in range(3):
            self.browser.wheel(*place, -120, ctrl=True)
            seen.append(self.ask(size))
            now = self.at(31, 12)
            assert all(abs(a - b) < 1.5 for a, b in zip(now, place)), (now, place, seen)
        steps = [s for s in (1, 2, 4, 8, 16, 32) if 40 * s > fit]
        assert seen == [[f"{s}\u00d7", 40 * s] for s in steps] + [seen[-1]] * (3 - len(steps)) and seen[-1] == ["32\u00d7", 1280], (seen, fit)
        # out again, in order of size, with fit where it belongs
        for _ in range(8):
            self.browser.wheel(*place, 120, ctrl=True)
        assert self.ask(size) == ["1\u00d7", 40]
        assert [c["zoom"] for c in self.ask("changes")][-1] == 1 and 0 in [c["zoom"] for c in self.ask("changes")]
        # without Ctrl the wheel scrolls; keys zoom, too
        for _ in range(2):
            self.browser.wheel(*place, -120)
        assert self.ask(size)[0] == "1\u00d7"
        self.ask("$('.frame').focus()")
        for key, shown in (("+", "2\u00d7"), ("+", "4\u00d7"), ("-", "2\u00d7"), ("0", "fit")):
            self.browser.key(key)
            assert self.ask(size)[0] == shown, (key, self.ask(size))
        assert self.ask("getComputedStyle($('.frame .layer')).imageRendering") == "pixelated"
        self.browser.quiet()

    def test_what_does_not_fit_is_moved(self):
        self.show("both(10, 200).slice(0, 2)", "{state: {mode: 'left', zoom: 6}}")
        self.ask("$('main').style.width = '600px'")
        self.browser.settle()
        scrolled = "(e => [e.scrollLeft, e.scrollTop])($('.stage-scroll'))"
        x, y, w, h = self.ask("(r => [r.x, r.y, r.width, r.height])($('.stage-scroll').getBoundingClientRect())")
        middle = (x + w / 2, y + h / 2)
        moved = lambda dx, dy: [(middle[0], middle[1]), (middle[0] + dx / 2, middle[1] + dy / 2), (middle[0] + dx, middle[1] + dy)]
        assert self.ask(scrolled) == [0, 0]
        self.browser.drag(moved(-120, -50), "middle")
        assert self.ask(scrolled) == [120, 50], self.ask(scrolled)
        self.ask("$('.frame').focus({preventScroll: true})")
        self.browser.key(" ", 32, ["keyDown"])
        self.browser.drag(moved(60, 20))
        self.browser.key(" ", 32, ["keyUp"])
        assert self.ask(scrolled) == [60, 30] and self.ask("$('.frame').className") == "frame left", self.ask(scrolled)
        assert self.ask("picks") == []
        # Space alone shows the other picture
        self.browser.key(" ", 32)
        assert self.ask("$('.frame').className") == "frame right"
        # arrow keys bring their pixel into sight
        for _ in range(4):
            self.ask("$('.frame').dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight', shiftKey: true}))")
        x2, _ = self.at(39, 10)
        assert self.ask("stage.pointed()[0]") == 39 and x < x2 < x + w, (x, x2, w)
        self.browser.quiet()


sys.exit(run_tests(Tests, "glint-canvas-"))
