"""Picture and pixel on the page of glint live in headless Chromium, over the real server: live_picture.py GLINT. Speaks TAP."""
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

import tap
from browser import Browser
from pictures import read_png
from tap import glint, programs

SIZE = (64, 36)
STORE = "glintLive.shown"
PINNED = "{'cubemap_trace.steps_hq': 3, 'resolve.fog': false}"
HELP = """
const $ = s => document.querySelector(s), all = s => [...document.querySelectorAll(s)];
const layers = () => all('.live-picture .frame .layer').filter(e => !e.hidden && getComputedStyle(e).visibility !== 'hidden');
const bytesOf = e => {
    const copy = document.createElement('canvas');
    Object.assign(copy, {width: e.width, height: e.height});
    const context = copy.getContext('2d', {willReadFrequently: true});
    context.drawImage(e, 0, 0);
    return [...context.getImageData(0, 0, e.width, e.height).data];
};
const asked = [], posted = [];
let flying = 0, most = 0, slow = 0, {bytes, post} = glintLive.api;
glintLive.api.bytes = async (path, signal) => {
    asked.push({path, signal});
    most = Math.max(most, ++flying);
    try { if (slow) await new Promise(done => setTimeout(done, slow)); return await bytes(path, signal); } finally { flying--; }
};
let lost = false;
glintLive.api.post = async (path, body, signal) => {
    posted.push({path, body});
    if (lost && path.endsWith('/run')) throw glintLive.api.failure('the device was lost <b>', 'device', 500);
    return post(path, body, signal);
};
0
"""


class Tests:
    def __init__(self, folder, browser):
        self.folder, self.browser = folder, browser
        capture = os.path.join(folder, "street.exr")
        glint("sample", "street", "--light=1", "-o", capture, f"--size={SIZE[0]}x{SIZE[1]}", "--cube-size=16", "--truth=1")
        self.capture = capture
        self.server = subprocess.Popen([sys.argv[1], "live", capture], stdout=subprocess.PIPE, text=True)
        self.url = self.server.stdout.readline().strip()

    def end(self):
        self.server.send_signal(signal.SIGINT)
        assert self.server.wait(timeout=20) == 0

    def ask(self, expression):
        return self.browser.evaluate(expression)

    def until(self, expression, seconds=20):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if value := self.ask(expression):
                return value
            time.sleep(0.02)
        raise AssertionError(f"not within {seconds} s: {expression}; {self.browser.messages} {self.ask('document.body.innerText')[:600]}")

    def show(self):
        for said in (self.browser.messages, self.browser.requests):
            said.clear()
        for url in ("about:blank", self.url):
            self.browser.call("Page.navigate", url=url)
        self.until(f"document.documentElement?.dataset.ready === 'yes' && {STORE}?.result && !{STORE}.busy() && !document.querySelector('.frame canvas')?.hidden")
        self.ask(HELP)
        self.look(image="composed")

    def look(self, **values):
        self.ask(f"{STORE}.setLook({{{', '.join(f'{k}: {v!r}' for k, v in values.items()).replace('None', 'null')}}})")
        self.settle()

    def settle(self):
        """Until nothing is asked any more."""
        self.until(f"!flying && !{STORE}.busy() && new Promise(done => setTimeout(() => done(!flying && !{STORE}.busy()), 60))")

    def pin(self):
        self.ask(f"{STORE}.pinState({{...{STORE}.state, set: {PINNED}}}, 'pinned')")
        self.until("layers().length === 2")
        self.settle()

    def press(self, text):
        self.ask(f"all('.stage .bar button').find(b => b.textContent === '{text}').click()")
        self.settle()

    def fetch(self, path):
        """What the server answers, as a list of bytes."""
        return bytes(self.ask(f"bytes('/api/v1/{path}').then(b => [...new Uint8Array(b)])"))

    def at(self, x, y, size=SIZE):
        self.ask("$('.frame').scrollIntoView({block: 'center'})")
        left, top, wide, high = self.ask("(r => [r.x, r.y, r.width, r.height])($('.frame').getBoundingClientRect())")
        return left + (x + 0.5) / size[0] * wide, top + (y + 0.5) / size[1] * high

    def readout(self, head):
        """{caption: [text, …]} of the pixel whose values begin with `head`."""
        self.until(f"$('.readout th')?.textContent.startsWith('{head}')")
        rows = self.ask("all('.readout tr').map(r => [...r.cells].map(c => c.textContent))")
        return {row[0]: row[1:-1] for row in rows[1:]}, rows[0][1:-1]

    def quiet(self):
        assert not [m for m in self.browser.messages if "status of 4" not in m], self.browser.messages
        host = self.url.split("#")[0]
        outside = [r for r in self.browser.requests if not r.startswith((host, "blob:" + host, "data:image/", "about:"))]
        assert not outside, outside

    def test_the_picture_is_what_view_draws(self):
        self.show()
        for words in ({"image": "composed", "exposure": 2, "view": "sRGB"}, {"image": "composed", "exposure": 0, "view": None}, {"image": "travelled"}, {"image": "depth_half", "low": 2, "high": 30, "scale": "linear"}):
            self.look(**words)
            path = self.ask("asked.at(-1).path.replace('/api/v1/', '')")
            png = os.path.join(self.folder, "picture.png")
            with open(png, "wb") as file:
                file.write(self.fetch(path.replace("format=raw", "format=png")))
            drawn = self.ask("bytesOf(layers()[0])")
            width, height = self.ask("[layers()[0].width, layers()[0].height]")
            rows = read_png(png)
            inside = [list(rows[y][x][:3]) for y in range(height) for x in range(width)]
            assert (len(rows[0]), len(rows)) == (width, height) and inside == [drawn[4 * i : 4 * i + 3] for i in range(width * height)], words
            assert len(set(map(tuple, zip(drawn[::4], drawn[1::4], drawn[2::4])))) > 20, words
        assert self.ask("all('.key .ticks span').map(s => s.textContent)")[::4] == ["2", "30"]
        self.quiet()

    def test_every_image_can_be_chosen(self):
        self.show()
        images = self.ask(f"{STORE}.result.images.map(i => [i.name, i.level, i.slot])")
        names = [n for n, level, _ in images if level == 0]
        assert self.ask("[...$('.live-images select').options].map(o => o.value)") == names and len(names) > 20
        slots = list(dict.fromkeys(s or "capture" for _, level, s in images if level == 0))
        assert [g.split(":")[0] for g in self.ask("all('.live-images optgroup').map(g => g.label)")] == slots
        for name in (*names[::5], *[n for n, level, _ in images if level > 0][::7]):
            self.look(image=name)
            assert self.ask(f"asked.at(-1).path.includes('image={name}&')"), (name, self.ask("asked.at(-1).path"))
            assert self.ask("$('.live-images select').value") == name.split(".level")[0]
            assert not self.ask("$('.live-over .note').textContent"), (name, self.ask("$('.live-over .note').textContent"))
        levels = [n for n, _, _ in images if n.split(".level")[0] == "lit_mips"]
        self.look(image="lit_mips")
        assert self.ask("[...all('.live-images select')[1].options].map(o => o.value)") == levels and len(levels) > 2
        # a search leaves what has all its words, and Enter takes the first
        self.ask("$('.live-images input').focus()")
        self.browser.call("Input.insertText", text="depth half")
        found = self.ask("all('.live-images optgroup option').map(o => o.value)")
        assert "depth_half" in found and len(found) < 12, found
        self.browser.key("Enter", 13)
        self.until(f"{STORE}.look.image === '{found[0]}'")
        # an image that a run does not have is said, and another is shown
        self.look(image="nothing")
        assert "nothing" in self.ask("$('.live-images .note').textContent") and self.ask(f"asked.at(-1).path.includes('image=' + {STORE}.result.picture + '&')")
        self.quiet()

    def test_exposure_asks_once_at_a_time_and_another_image_gives_up(self):
        self.show()
        self.ask("most = 0, slow = 80, asked.length = 0")
        mean = lambda: sum(self.ask("bytesOf(layers()[0]).filter((_, i) => i % 4 < 3)"))
        before = mean()
        for i in range(1, 9):
            self.ask(f"(s => {{ s.value = {i / 4}; s.dispatchEvent(new Event('input')); }})($('.exposure input'))")
            time.sleep(0.03)
        self.settle()
        paths = self.ask("asked.map(a => a.path)")
        assert self.ask("most") == 1 and 2 <= len(paths) < 8 and "exposure=2&" in paths[-1], paths
        assert mean() > before and self.ask("$('.exposure button').textContent") == "+2 EV"
        self.ask("$('.exposure button').click()")
        self.settle()
        assert mean() == before and self.ask("$('.exposure button').disabled")
        self.ask(f"slow = 300, asked.length = 0, {STORE}.setLook({{image: 'travelled'}}), {STORE}.setLook({{image: 'depth_half'}})")
        self.settle()
        given = self.ask("asked.map(a => [a.path.match(/image=([^&]*)/)[1], a.signal.aborted])")
        assert given == [["travelled", True], ["depth_half", False]], given
        self.ask("slow = 0")
        self.quiet()

    def test_a_range_is_checked_before_it_is_asked_for(self):
        self.show()
        self.look(image="travelled")
        low, high = self.ask("all('.live-view input[type=text]').map(i => i.placeholder)")
        assert low.startswith("auto: ") and high.startswith("auto: "), (low, high)
        put = lambda i, text: self.ask(f"(f => {{ f.value = '{text}'; f.dispatchEvent(new Event('change')); }})(all('.live-view input[type=text]')[{i}])")
        put(0, "4")
        put(1, "9,5")
        self.settle()
        assert self.ask(f"[{STORE}.look.low, {STORE}.look.high]") == [4, 9.5]
        ticks = self.ask("all('.key .ticks span').map(s => s.textContent)")
        assert ticks[0] == "4" and ticks[4] == "9.5", ticks
        count = self.ask("asked.length")
        for i, text, why in ((0, "10", "below"), (1, "x", "number")):
            put(i, text)
            self.settle()
            assert self.ask("asked.length") == count and why in self.ask("$('.live-view .why').textContent")
            assert self.ask(f"all('.live-view input[type=text]')[{i}].getAttribute('aria-invalid')") == "true"
            put(i, ("4", "9.5")[i])
        self.ask("all('.live-view button').find(b => b.textContent === 'Auto range').click()")
        self.settle()
        assert self.ask(f"[{STORE}.look.low, {STORE}.look.high]") == [None, None]
        # NaN and infinity are counted
        invalid = self.ask("bytes(asked.at(-1).path).then(b => JSON.parse(new TextDecoder().decode(new Uint8Array(b, 4, new DataView(b).getUint32(0, true)))).invalid)")
        said = self.ask("$('.live-picture > .note').textContent")
        assert (f"{invalid:,}".replace(",", "\u202f") in said) if invalid else not said, (invalid, said)
        self.look(image="composed")
        assert self.ask("$('.live-picture > .note').hidden && getComputedStyle($('.live-view .exposure')).display !== 'none'")
        self.quiet()

    def test_b_is_shown_in_the_colours_of_a(self):
        self.show()
        self.look(image="travelled")
        self.pin()
        a, b = self.ask("asked.slice(-2).map(a => Object.fromEntries(new URLSearchParams(a.path.split('?')[1])))")
        shown = self.ask("bytesOf(layers()[0])"), self.ask("bytesOf(layers()[1])")
        assert shown[0] != shown[1] and a["run"] != b["run"] and float(b["low"]) < float(b["high"]) and b["image"] == "travelled", (a, b)
        assert self.ask("all('.frame .tag').map(t => t.textContent)") == ["A", "B: pinned"]
        # only when it is looked at, the heat map is asked for
        assert not self.ask("asked.some(a => a.path.includes('/difference'))")
        self.press("Heat map")
        self.until("layers().length === 1 && asked.at(-1).path.includes('/difference')")
        heat = self.ask("bytesOf(layers()[0])")
        colours = [tuple(heat[i : i + 3]) for i in range(0, len(heat), 4)]
        equal = [shown[0][i : i + 3] == shown[1][i : i + 3] for i in range(0, len(heat), 4)]
        nothing = max(set(colours), key=colours.count)
        assert all(same for same, c in zip(equal, colours) if c == nothing) or sum(equal) < len(equal), "where nothing differs"
        assert any(c != nothing for c in colours)
        # its range is not that of the picture
        fields = "all('.live-view .pair .pair input')"
        self.until(f"{fields}[1].placeholder.startsWith('auto: ')")
        self.ask(f"{fields}[1].value = '1e6', {fields}[1].dispatchEvent(new Event('change')), 1")
        self.until(f"{STORE}.look.heatHigh === 1e6 && {STORE}.look.high === null && asked.at(-1).path.includes('high=1000000')")
        self.until("layers().length === 1 && bytesOf(layers()[0]).join() !== " + json.dumps(",".join(str(b) for b in heat)))
        self.ask(f"{fields}[1].closest('.pair').querySelector('button').click(), 1")
        self.until(f"{STORE}.look.heatHigh === null && bytesOf(layers()[0]).join() === " + json.dumps(",".join(str(b) for b in heat)))
        self.press("Slider")
        self.until(f"getComputedStyle({fields}[1]).display !== 'none' && {fields}[1].value === ''")
        # the mode is kept while B goes and comes
        self.ask(f"{STORE}.unpin()")
        self.until("layers().length === 1")
        self.pin()
        assert self.ask(f"$('.frame').className === 'frame slider' && {STORE}.look.mode === 'slider'")
        self.quiet()

    def test_values_under_the_pointer_are_those_of_the_images(self):
        self.show()
        self.pin()
        self.until(f"{STORE}.truth")
        self.browser.point_at(*self.at(20, 25))
        values, channels = self.readout("20,25")
        answer = self.ask(f"post('/api/v1/values', {{x: 20, y: 25, size: {list(SIZE)}, of: [{STORE}.result, {STORE}.pinned.result, {STORE}.truth.result].map(r => ({{run: r.run, image: r.picture}}))}})")["values"]
        assert channels[:3] == ["R", "G", "B"] and list(values)[:3] == ["A", "B", "B \u2212 A"] and len(values) == 4, values
        number = lambda text: float(text.replace("\u2212", "-"))
        for row, v in zip((values["A"], values["B"], list(values.values())[3]), answer):
            for text, expected in zip(row, v["values"]):
                assert abs(number(text) - expected) <= 1e-5 * abs(expected), (values, answer)
        for k in range(3):
            assert abs(number(values["B \u2212 A"][k]) - (answer[1]["values"][k] - answer[0]["values"][k])) < 1e-5 * (1 + abs(answer[0]["values"][k]))
        # an image that the capture's path tracer knows nothing of has no truth beside it
        self.look(image="travelled")
        self.browser.point_at(*self.at(8, 9, (SIZE[0] // 2, SIZE[1] // 2)))
        values, channels = self.readout("8,9")
        assert channels == ["Z"] and list(values) == ["A", "B", "B \u2212 A"], values
        # at most one question is under way, and the last one is answered
        self.ask("posted.length = 0")
        for x in range(4, 30):
            self.browser.mouse("mouseMoved", *self.at(x, 3, (SIZE[0] // 2, SIZE[1] // 2)))
        self.readout("29,3")
        assert self.ask("posted.filter(p => p.path.endsWith('/values')).length") <= 27
        self.quiet()

    def test_a_click_draws_the_pixel_and_the_drawing_follows(self):
        self.show()
        assert self.ask("$('.live-pixel h3').closest('[hidden]') !== null")
        self.browser.click(*self.at(20, 25))
        self.until("$('.live-pixel[aria-busy=false] pre')?.textContent.includes('pixel 20,25')")
        assert self.until("$('.live-pixel img').naturalWidth > 100 && $('.live-pixel img').src.startsWith('blob:')")
        assert self.ask("$('.live-pixel h3').textContent === 'Pixel 20,25' && all('.live-pixel svg').length === 0 && !$('.cross.picked').hidden")
        expected = glint("probe", self.capture, "20,25").stdout
        assert self.ask("$('.live-pixel pre').textContent").split("\n\n")[1] == expected.split("\n\n")[1]
        # the pipeline's own ray came first; what probe ends with, the comparison, stands above the drawing
        assert self.ask("posted.filter(p => p.path.endsWith('/probe')).map(p => p.body.reference)") == [False, True]
        cells = self.ask("all('.live-pixel .outcome tbody tr').map(r => [...r.cells].map(c => c.textContent))")
        assert len(cells) > 3 and all(" ".join(row[1:]) in " ".join(expected.split("\n\n")[-1].split()) for row in cells), cells
        assert self.ask("$('.live-pixel .explain').textContent") == "glint explain run 20,25"
        # the drawing as large as the window
        self.ask("all('.live-pixel button').find(b => b.textContent === 'Enlarge').click()")
        self.until("$('dialog.drawing').open && $('dialog.drawing img').naturalWidth > 100")
        assert self.ask("$('dialog.drawing img').offsetWidth > 1.5 * $('.live-pixel figure img').offsetWidth")
        self.browser.key("Escape", 27)
        self.until("!$('dialog.drawing').open")
        # where nothing is pointed at, the values are those of the chosen pixel
        self.browser.point_at(*self.at(3, 4))
        self.readout("3,4")
        self.browser.point_at(2, 2)
        self.readout("20,25")
        # arrow keys go on; sliders change what is drawn
        self.ask("$('.live-pixel figure').focus()")
        self.browser.key("ArrowDown", 40)
        self.until("$('.live-pixel[aria-busy=false] pre')?.textContent.includes('pixel 20,26')")
        before = self.ask("posted.filter(p => p.path.endsWith('/probe')).length")
        self.ask(f"{STORE}.change(s => {{ s.set['cubemap_trace.steps_hq'] = 5; }})")
        self.until(f"posted.filter(p => p.path.endsWith('/probe')).length > {before} && !!$('.live-pixel[aria-busy=false]')")
        assert self.ask("posted.filter(p => p.path.endsWith('/probe')).at(-1).body.state.set") == {"cubemap_trace.steps_hq": 5}
        # a pixel of a half-size image is one of the frame; a texel of a cube map is none
        self.look(image="travelled")
        self.browser.click(*self.at(5, 6, (SIZE[0] // 2, SIZE[1] // 2)))
        self.until(f"{STORE}.look.x === 11 && {STORE}.look.y === 13")
        self.look(image="cubemap_color")
        self.browser.click(*self.at(3, 3))
        assert "nothing to probe" in self.ask("$('.live-picture > .note').textContent") and self.ask(f"{STORE}.look.x") == 11
        self.ask("$('.live-pixel figure').focus()")
        self.browser.key("Escape", 27)
        assert self.ask(f"{STORE}.look.x === null && $('.live-pixel h3').closest('[hidden]') !== null")
        self.quiet()

    def test_a_truth_stands_beside_what_it_is_the_truth_of(self):
        self.show()
        self.ask(f"{STORE}.pinAnswer('truth', {STORE}.effect, 'truth')")
        self.until("layers().length === 2")
        image, compares = self.ask(f"[{STORE}.look.image, {STORE}.pinned.result.compares]")
        assert image in compares and image != "composed", (image, compares)
        # beside another image it says nothing, and is not shown
        self.look(image="composed")
        self.until("layers().length === 1 && all('.live-picture > .note').some(e => !e.hidden && e.textContent.includes('not comparable with composed'))")
        assert self.ask("!all('.stage .bar button').some(b => b.textContent === 'Heat map')")
        self.ask(f"all('.live-picture > .note button').find(b => b.textContent === 'Show {image}').click()")
        self.until(f"layers().length === 2 && {STORE}.look.image === '{image}'")
        # the picture of another pipeline beside the picture; an image that it lacks beside nothing
        self.ask(f"{STORE}.pinState({{...{STORE}.state, use: {{resolve_sharp: 'none'}}}}, 'less')")
        self.until("all('.live-picture > .note').some(e => !e.hidden && e.textContent.includes('has no image'))")
        self.look(image="composed")
        self.until("layers().length === 2 && all('.live-picture > .note').every(e => e.hidden)")
        self.quiet()

    def test_a_failure_keeps_the_picture(self):
        self.show()
        before = self.ask("bytesOf(layers()[0])")
        self.ask("lost = true")
        self.ask(f"{STORE}.change(s => {{ s.set['cubemap_trace.steps_hq'] = 6; }})")
        self.until("!$('.live-over .note').hidden")
        text = self.ask("$('.live-over .note').textContent")
        assert "the device was lost <b>" in text and "last run that succeeded" in text, text
        self.ask("lost = false")
        assert self.ask("bytesOf(layers()[0])") == before
        self.ask(f"{STORE}.change(s => {{ s.set['cubemap_trace.steps_hq'] = 7; }})")
        self.until("$('.live-over .note').hidden")
        # a draft says that it is one, and is as large as the whole picture
        box = self.ask("$('.frame').getBoundingClientRect().width")
        self.ask(f"post('/api/v1/run', {{state: {STORE}.state, draft: true, client: 'test'}}).then(r => {{ {STORE}.result = r; {STORE}.emit('result'); }})")
        self.until(f"layers()[0].width === {SIZE[0] // 2}")
        assert self.ask("!$('.live-over .draft').hidden") and abs(self.ask("$('.frame').getBoundingClientRect().width") - box) < 1
        self.ask(f"{STORE}.progress = {{what: 'pass 3 of 9', done: 0.25}}, {STORE}.emit('progress')")
        assert self.ask("$('.live-over .progress').getAttribute('aria-valuenow')") == "25"
        self.quiet()

    def test_narrow_dark_and_by_keys(self):
        self.show()
        for dark in (True, False):
            self.browser.look(dark=dark)
            self.browser.settle()
            faint = """(e => { const c = s => s.match(/[\\d.]+/g).slice(0, 3).map(v => { v /= 255; return v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; });
                const l = s => { const [r, g, b] = c(s); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
                const ground = s => { for (let p = s; p; p = p.parentElement) { const b = getComputedStyle(p).backgroundColor; if (!b.endsWith(', 0)')) return b; } return 'rgb(255,255,255)'; };
                return e.filter(x => x.textContent.trim() && x.offsetWidth && !x.disabled).map(x => { const [a, b] = [l(getComputedStyle(x).color), l(ground(x))].sort((p, q) => q - p);
                    return [x.textContent.slice(0, 30), (a + 0.05) / (b + 0.05)]; }).filter(([, k]) => k < 4.5); })(all('.live-picture p, .live-picture span, .live-picture button, .live-picture legend, .live-pixel p'))"""
            assert self.ask(faint) == [], (dark, self.ask(faint))
        self.browser.call("Emulation.setDeviceMetricsOverride", width=400, height=800, deviceScaleFactor=1, mobile=False)
        wide = self.ask("all('.live-picture, .live-picture > *, .live-view > label, .live-pixel').map(e => e.getBoundingClientRect().right).filter(r => r > 400)")
        assert not wide, wide
        self.browser.call("Emulation.clearDeviceMetricsOverride")
        # Tab reaches every control, each of which has a name
        controls = "all('.live-picture :is(input, select, button, [tabindex=\"0\"])').filter(e => e.offsetWidth && !e.disabled)"
        assert self.ask(f"{controls}.every(e => e.getAttribute('aria-label') || e.textContent.trim() || e.labels?.length)")
        self.ask(f"{controls}[0].focus(), window.reached = new Set(), document.addEventListener('focusin', e => reached.add(e.target)), 0")
        for _ in range(self.ask(f"{controls}.length") + 2):
            self.browser.key("Tab", 9)
        missed = self.ask(f"{controls}.slice(1).filter(e => !reached.has(e)).map(e => e.outerHTML.slice(0, 80))")
        assert not missed, missed
        self.quiet()


def main():
    try:
        with tempfile.TemporaryDirectory(prefix="glint-live-picture-") as folder, Browser() as browser:
            tests = Tests(folder, browser)
            try:
                return tap.run(tests)
            finally:
                tests.end()
    except programs.Missing as missing:
        print(f"Bail out! {missing}")
        return 1


sys.exit(main())
