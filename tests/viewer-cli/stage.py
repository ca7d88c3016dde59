"""Pages of glint diff in headless Chromium: slider, flicker, heat map, values; side-by-side and animated PNG. stage.py GLINT.
Speaks TAP."""
import json
import os
import re
import struct
import subprocess
import sys
import zlib

from browser import run_tests
from pictures import read_png
from tap import glint, programs

SIZE = (48, 27)
STAGE = "document.querySelector('.stage')"  # of the final image
FRAME = STAGE + ".querySelector('.frame')"


class Tests:
    def __init__(self, folder, browser):
        self.folder, self.browser = folder, browser
        capture = self.path("room.exr")
        glint("sample", "room", "--light=4", "-o", capture, f"--size={SIZE[0]}x{SIZE[1]}", "--cube-size=16")
        glint("replay", capture, "-o", self.path("one"), "--diagnostics")
        glint("replay", capture, "-o", self.path("two"), "--diagnostics", "--set=cubemap_trace.steps_hq=3", "--set=resolve.fog=false")
        self.page = self.path("page.html")
        self.report = json.loads(glint("diff", self.path("one"), self.path("two"), "--json", "--html", self.page, status=2).stdout)
        self.composed = next(i for i in self.report["images"] if i["name"] == "composed")

    def path(self, name):
        return os.path.join(self.folder, name)

    def show(self):
        self.browser.show(self.page)
        self.ask("sessionStorage.clear()")
        self.browser.show(self.page)
        self.ask(STAGE + ".scrollIntoView()")

    def ask(self, expression):
        return self.browser.evaluate(expression)

    def press(self, text):
        self.ask(f"[...{STAGE}.querySelectorAll('.bar button')].find(b => b.textContent === '{text}').click()")
        self.browser.settle()

    def at(self, x, y, width=SIZE[0]):
        """The position of a pixel of the final image in the window."""
        left, top, wide, high = self.ask(f"(r => [r.x, r.y, r.width, r.height])({FRAME}.getBoundingClientRect())")
        return left + (x + 0.5) / width * wide, top + (y + 0.5) / SIZE[1] * high

    def readout(self):
        """{caption: [value, …]}, and the pixel that the values are of."""
        self.ask(f"new Promise(done => {{ const wait = () => {STAGE}.querySelector('.readout table') ? done() : setTimeout(wait, 10); wait(); }})")
        rows = self.ask(f"[...{STAGE}.querySelectorAll('.readout tr')].map(r => [...r.cells].map(c => c.textContent))")
        number = lambda t: float(t.replace("\u2212", "-").replace("\u221e", "inf"))
        return {row[0]: [number(v) for v in row[1:-1]] for row in rows[1:]}, rows[0]

    def test_the_table_lists_what_differs_in_the_order_of_the_passes(self):
        self.show()
        rows = self.ask("[...[...document.querySelectorAll('section')].find(s => s.querySelector('h2')?.textContent.startsWith('Images that differ')).querySelectorAll('tbody tr')].map(r => [...r.cells].map(c => c.textContent))")
        expected = [(i["slot"], i["name"]) for i in self.report["images"] if i["status"] or i.get("differing")]
        assert [(r[1], r[2]) for r in rows] == expected and 3 < len(rows) < len(self.report["images"]), rows
        facts = self.ask("document.querySelector('header dl').textContent")
        assert f"{self.report['first']['slot']}: {self.report['first']['image']}" in facts, facts
        settings = self.ask("document.querySelector('main table').textContent")
        assert "cubemap_trace.steps_hq" in settings and "resolve.fog" in settings, settings
        self.browser.quiet()

    def test_a_click_on_a_head_sorts(self):
        self.show()
        heads = "[...document.querySelectorAll('main > section')].find(s => s.querySelector('h2')?.textContent.startsWith('Images that differ'))"
        column = f"[...{heads}.querySelectorAll('tbody tr')].map(r => +r.cells[5].textContent.replace(/\\D/g, ''))"
        self.ask(f"{heads}.querySelectorAll('th button')[5].click()")
        values = self.ask(column)
        assert values == sorted(values) and len(set(values)) > 1, values
        self.ask(f"{heads}.querySelectorAll('th button')[5].click()")
        assert self.ask(column) == values[::-1] or self.ask(column) == sorted(values, reverse=True)

    def test_the_slider_cuts_the_second_picture_by_pointer_and_by_keys(self):
        self.show()
        cut = lambda: float(re.search(r"([\d.]+)%\)", self.ask(f"{FRAME}.querySelectorAll('img')[1].style.clipPath")).group(1))
        assert cut() == 50
        self.browser.click(*self.at(SIZE[0] / 4 - 0.5, 10))
        assert abs(cut() - 25) < 0.5, cut()
        self.ask(STAGE + ".querySelector('input[type=range]').focus()")
        self.browser.key("ArrowRight", 39)
        assert 25 < cut() < 26, cut()
        # the pixels on the left and right of the line are those of the two images
        sources = self.ask(f"[...{FRAME}.querySelectorAll('img')].map(i => [i.src.length, i.naturalWidth, i.hidden])")
        assert all(not hidden and width == SIZE[0] for _, width, hidden in sources), sources
        assert self.ask(f"{FRAME}.querySelectorAll('img')[0].src !== {FRAME}.querySelectorAll('img')[1].src")
        self.browser.quiet()

    def test_the_values_under_the_pointer_are_those_of_the_images(self):
        self.show()
        most = self.composed["largest"]
        self.browser.point_at(*self.at(most["x"], most["y"]))
        values, heads = self.readout()
        assert heads[0] == f"{most['x']},{most['y']}" and heads[1:5] == ["R", "G", "B", "A"], heads
        k = heads.index(most["channel"]) - 1
        for caption, expected in (("one", most["a"]), ("two", most["b"]), ("two \u2212 one", most["b"] - most["a"])):
            assert abs(values[caption][k] - expected) <= 6e-6 * max(abs(most["a"]), abs(most["b"])), (caption, values, most)

    def test_keys_go_from_pixel_to_pixel(self):
        self.show()
        self.ask(FRAME + ".focus()")
        self.browser.key("ArrowRight", 39)
        _, before = self.readout()
        self.browser.key("ArrowDown", 40)
        self.browser.settle()
        _, after = self.readout()
        x, y = map(int, before[0].split(","))
        assert after[0] == f"{x},{y + 1}" and not self.ask(FRAME + ".querySelector('.cross').hidden"), (before, after)

    def unfold(self, name):
        """Opens the fold of an image: an expression for it."""
        fold = f"[...document.querySelectorAll('.fold')].find(f => f.firstChild.textContent.includes(': {name},'))"
        self.ask(f"{fold}.open = true")
        self.ask(f"new Promise(done => {{ const wait = () => {fold}.querySelector('.stage') ? done() : setTimeout(wait, 10); wait(); }})")
        return fold

    def test_every_image_that_differs_is_shown_the_final_ones_first(self):
        self.show()
        stages = self.ask("[...document.querySelectorAll('main > section')].filter(s => s.querySelector('.stage')).map(s => s.querySelector('h2').textContent)")
        differing = [f"{i['slot']}: {i['name']}" for i in self.report["images"] if i.get("differing")]
        assert stages[0] == "compose: composed" and "upscale: reflection" in stages and len(stages) == 3, stages
        folds = self.ask("[...document.querySelectorAll('main > section > .fold')].map(f => f.firstChild.textContent.split(',')[0])")
        folds = [f for f in folds if ": " in f]
        assert folds == [d for d in differing if d not in stages] and len(folds) + len(stages) > 8, (folds, differing)
        for name in folds:
            fold = self.unfold(name.split(": ")[1])
            assert self.ask(f"{fold}.querySelectorAll('.stage').length") == 1
        self.browser.quiet()

    def test_colours_have_a_key_and_values_have_names(self):
        self.show()
        fold = self.unfold("cubemap_end")
        items = self.ask(f"[...{fold}.querySelectorAll('.key .items span')].map(s => s.textContent)")
        known = {r["name"].replace("_", " ") for r in self.reasons()}
        assert len(items) > 1 and all(re.fullmatch(r"(.+?) [\d.]+ % \u00b7 [\d.]+ %", i).group(1) in known for i in items), items
        shares = [[float(s) for s in re.findall(r"([\d.]+) %", i)] for i in items]
        assert all(abs(sum(s) - 100) < 0.1 * len(items) for s in zip(*shares)), items
        largest = next(i for i in self.report["images"] if i["name"] == "cubemap_end")["largest"]
        x, y, w, h = self.ask(f"{fold}.scrollIntoView(), (r => [r.x, r.y, r.width, r.height])({fold}.querySelector('.frame').getBoundingClientRect())")
        self.browser.point_at(x + (largest["x"] + 0.5) / (SIZE[0] / 2) * w, y + (largest["y"] + 0.5) / ((SIZE[1] + 1) // 2) * h)
        self.ask(f"new Promise(done => {{ const wait = () => {fold}.querySelector('.readout table') ? done() : setTimeout(wait, 10); wait(); }})")
        cells = self.ask(f"[...{fold}.querySelectorAll('.readout tbody tr')].map(r => r.cells[1].textContent)")
        names = [r["name"].replace("_", " ") for r in self.reasons()]
        assert cells[:2] == [f"{int(v)}: {names[int(v)]}" for v in (largest["a"], largest["b"])] and cells[2] == "another", cells
        # distances have a scale with numbers
        fold = self.unfold("travelled")
        ticks = self.ask(f"[...{fold}.querySelectorAll('.ticks span')].map(s => +s.textContent)")
        assert len(ticks) == 5 and ticks == sorted(ticks) and ticks[0] < ticks[4], ticks
        self.browser.quiet()

    def reasons(self):
        with open(os.path.join(self.path("one"), "run.json"), encoding="utf-8") as file:
            return json.load(file)["end_reasons"]

    def test_values_are_summed_up_as_view_prints_them(self):
        self.show()
        fold = "[...document.querySelectorAll('.fold')].find(f => f.firstChild.textContent.startsWith('Values of both'))"
        self.ask(f"{fold}.open = true")
        self.ask(f"new Promise(done => {{ const wait = () => {fold}.querySelector('table') ? done() : setTimeout(wait, 10); wait(); }})")
        rows = self.ask(f"[...{fold}.querySelectorAll('tbody tr')].map(r => [...r.cells].map(c => c.textContent.replace('\u2212', '-')))")
        printed = [(run, c) for run in ("one", "two") for c in json.loads(glint("view", f"{self.path(run)}:composed", "--stats", "--json").stdout)["channels"]]
        assert len(rows) == len(printed), rows
        for row, (run, channel) in zip(rows, printed):
            assert row[:2] == [run, channel["channel"]], row
            for text, key in zip(row[2:8], ("min", "p1", "median", "p99", "max", "mean")):
                assert abs(float(text) - channel[key]) <= 0.06 * abs(channel[key]) + 1e-4, (row, channel)  # two digits at least
        self.browser.quiet()

    def test_what_is_no_number_is_said_in_words(self):
        for name, add in (("root.exr", "-1"), ("number.exr", "0.25")):  # the root of a negative number is not one
            subprocess.run(["oiiotool", "--create", "12x8", "3", "--addc", add, "--powc", "0.5", "-d", "float", "-o", self.path(name)], check=True, env=programs.ENVIRONMENT)
        out = self.path("root.html")
        glint("diff", self.path("root.exr"), self.path("number.exr"), "--html", out, status=2)
        self.browser.show(out)
        self.browser.point_at(*self.ask("(r => [r.x + r.width / 3, r.y + r.height / 3])(document.querySelector('.frame').getBoundingClientRect())"))
        self.ask("new Promise(done => { const wait = () => document.querySelector('.readout table') ? done() : setTimeout(wait, 10); wait(); })")
        cells = self.ask("[...document.querySelectorAll('.readout tbody tr')].map(r => r.cells[1].textContent)")
        assert cells[0] == "not a number" and float(cells[1]) > 0 and cells[2] == "only one is finite", cells
        text = self.ask("document.querySelector('main').textContent")
        assert "not a number" in text and not re.search(r"\bnan\b", text), text[:600]
        self.browser.quiet()

    def test_flicker_shows_one_and_then_the_other(self):
        self.show()
        self.press("Flicker")
        hidden = f"{FRAME}.querySelectorAll('img')[1].style.visibility"
        seen = self.ask(f"new Promise(done => {{ const seen = []; const look = () => {{ seen.push({hidden}); seen.length < 30 ? setTimeout(look, 50) : done(seen); }}; look(); }})")
        assert {"hidden", ""} == set(seen), seen
        self.browser.quiet()

    def test_one_picture_alone_the_heat_map_and_both_beside_each_other(self):
        self.show()
        visible = f"[...{FRAME}.querySelectorAll('img')].filter(i => !i.hidden).map(i => i.alt)"
        self.press("one")
        assert self.ask(visible) == ["one"]
        self.press("difference")
        assert self.ask(visible) == ["difference"]
        self.press("Side by side")
        assert self.ask(visible) == ["one", "two"]
        lefts = self.ask(f"[...{FRAME}.querySelectorAll('img')].map(i => i.getBoundingClientRect().x)")
        assert lefts[1] > lefts[0] + 100, lefts
        self.browser.point_at(*self.at(SIZE[0] + 7, 9, 2 * SIZE[0]))
        assert self.readout()[1][0] == "7,9"
        self.browser.quiet()

    def test_the_histogram_s_shares_sum_to_one(self):
        self.show()
        shares = self.ask("[...[...document.querySelectorAll('main > section')].find(s => s.querySelector('.stage')).querySelectorAll('details tbody tr')].map(r => +r.cells[r.cells.length - 1].textContent)")
        assert len(shares) > 1 and abs(sum(shares) - 100) < 0.05 * len(shares), shares

    def test_dark_and_light(self):
        for dark, ground in ((True, "rgb(22, 24, 29)"), (False, "rgb(255, 255, 255)")):
            self.browser.look(dark=dark)
            self.show()
            assert self.ask("getComputedStyle(document.body).backgroundColor") == ground
        self.browser.quiet()

    def test_two_files_make_a_page_too(self):
        for name, what in (("a.exr", "1,0.5,0"), ("b.exr", "1,0.5,0.25")):
            subprocess.run(["oiiotool", "--create", "12x8", "3", f"--fill:color={what}", "12x8", "-d", "float", "-o", self.path(name)], check=True, env=programs.ENVIRONMENT)
        out = self.path("files.html")
        glint("diff", self.path("a.exr"), self.path("b.exr"), "--html", out, status=2)
        self.browser.show(out)
        self.browser.point_at(*self.ask("(r => [r.x + r.width / 3, r.y + r.height / 3])(document.querySelector('.frame').getBoundingClientRect())"))
        values, heads = self.readout()
        assert heads[0] == "4,2" and values == {"a.exr": [1, 0.5, 0], "b.exr": [1, 0.5, 0.25], "b.exr \u2212 a.exr": [0, 0, 0.25]}, (heads, values)
        # a page of two equal runs has nothing to list, and shows the image
        glint("diff", self.path("a.exr"), self.path("a.exr"), "--html", out)
        self.browser.show(out)
        assert self.ask("document.querySelectorAll('.stage').length") == 1 and "1 of 1 images are equal" in self.ask("document.body.textContent")
        self.browser.quiet()

    def test_the_animated_png_holds_both_pictures(self):
        beside, flicker = self.path("beside.png"), self.path("flicker.png")
        pair = (self.path("one:composed"), self.path("two:composed"))
        glint("diff", "-q", *pair, "--side-by-side", beside, "--flicker", flicker, status=2)
        with open(flicker, "rb") as file:
            data = file.read()
        chunks, at = [], 8
        while at < len(data):
            (length,) = struct.unpack_from(">I", data, at)
            chunks.append((data[at + 4 : at + 8], data[at + 8 : at + 8 + length]))
            assert zlib.crc32(data[at + 4 : at + 8 + length]) == struct.unpack_from(">I", data, at + 8 + length)[0]
            at += 12 + length
        kinds = [kind for kind, _ in chunks]
        assert kinds.index(b"acTL") < kinds.index(b"fcTL") < kinds.index(b"IDAT") and kinds[-3:] == [b"fcTL", b"fdAT", b"IEND"], kinds
        assert dict(chunks)[b"acTL"] == struct.pack(">II", 2, 0)
        sequence = [struct.unpack(">I", body[:4])[0] for kind, body in chunks if kind in (b"fcTL", b"fdAT")]
        assert sequence == [0, 1, 2], sequence
        width, height = struct.unpack_from(">II", dict(chunks)[b"IHDR"])
        rows = zlib.decompress(dict(chunks)[b"fdAT"][4:])
        assert len(rows) == height * (1 + 3 * width) and not any(rows[:: 1 + 3 * width])
        second = [[tuple(rows[y * (1 + 3 * width) + 1 + 3 * x :][:3]) for x in range(width)] for y in range(height)]
        first, both = read_png(flicker), read_png(beside)
        assert len(first) == height and first != second
        assert all(both[y][:width] == first[y] and both[y][width + 12 : 2 * width + 12] == second[y] for y in range(height))


sys.exit(run_tests(Tests, "glint-stage-"))
