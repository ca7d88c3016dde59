"""glint report over runs, read back in headless Chromium: report.py GLINT. Speaks TAP."""
import json
import os
import re
import sys

from browser import run_tests
from tap import PLAIN, glint

NAME = "<img src=x onerror=alert(1)>.exr"
# A section's table as lists of texts, without intervals and units.
TABLE = """(title => [...[...document.querySelectorAll('main > section')].find(s => s.querySelector('h2')?.textContent === title)
    .querySelectorAll('table')].map(t => [...t.rows].map(r => [...r.cells].filter(c => !c.classList.contains('interval'))
    .map(c => (c.querySelector('button') || c).textContent))))"""


class Tests:
    def __init__(self, folder, browser):
        self.folder, self.browser = folder, browser
        self.capture = self.path(NAME)
        glint("sample", "room", "--light=4", "-o", self.capture, "--size=96x54", "--cube-size=16", "--truth=1")
        glint("replay", self.capture, "-o", self.path("a"), "--against=truth", "--set=downsample.jitter=false")
        # errors of an older run must not stay
        os.makedirs(self.path("b"))
        with open(self.path("b/errors.json"), "w", encoding="utf-8") as file:
            file.write("{}")
        glint("replay", self.capture, "-o", self.path("b"), "--set=downsample.jitter=false",
              "--set=cubemap_trace.steps_hq=8", "--use=blur=none", "--skip=temporal", "--repeat=3")

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_json(self, name):
        with open(os.path.join(self.path(name), "run.json"), encoding="utf-8") as file:
            return json.load(file)

    def show(self, *runs):
        out = self.path(f"{'-'.join(runs)}.html")
        if not os.path.exists(out):
            glint("report", *(self.path(r) for r in runs), "-o", out)
        self.browser.show(out)

    def compared(self):
        """The folder of a comparison of two presets."""
        folder = self.path("compared")
        if not os.path.exists(folder):
            glint("compare", self.capture, "--presets=mafia3,kf2", "--repeat=1", "-o", folder)
        return folder

    def table(self, title, which=0):
        """Its lines below the headings."""
        return self.browser.evaluate(f"{TABLE}({json.dumps(title)})[{which}].slice(1)")

    def test_all_of_a_run_is_reported(self):
        run = self.run_json("b")
        self.show("b")
        facts = self.browser.evaluate("Object.fromEntries([...document.querySelectorAll('header dt')].map(e => [e.textContent, e.nextSibling.textContent]))")
        assert facts["device"] == run["device"]["name"] and facts["capture"] == run["capture"]["path"], facts
        assert NAME in facts["capture"] and facts["resolution"] == "96 × 54", facts
        plan = dict(self.table("Plan"))
        assert list(plan) == [p["slot"] for p in run["passes"]]
        for p in run["passes"]:
            assert p["reason"] in plan[p["slot"]] and (p["ran"] or "not run" in plan[p["slot"]]), plan[p["slot"]]
        assert any(not p["ran"] for p in run["passes"])
        parameters = {(slot, name): value for slot, name, value in self.table("Parameters")}
        assert len(parameters) == sum(len(p["parameters"]) for p in run["passes"])
        assert parameters["downsample", "jitter"] == "no" and parameters["cubemap_trace", "steps_hq"] == "8"
        self.browser.quiet()

    def test_times_are_those_of_the_run(self):
        run = self.run_json("b")
        self.show("b")
        for which, cached in ((1, False), (3, True)):  # each follows the table of its chart
            report = dict(self.table("Times", which))
            passes = [p for p in run["passes"] if p["ran"] and p.get("cached_work", False) == cached]
            assert list(report) == [p["slot"] for p in passes], (list(report), cached)
            for p in passes:
                found = float(report[p["slot"]].replace("\u202f", ""))
                assert abs(found - p["time_ns"]["median"] / 1e6) <= 0.06 * found + 1e-4, (p, found)  # two digits at least

    def test_cold_times_are_marked_and_not_drawn_beside_others(self):
        charts = "[...document.querySelectorAll('main > section')].find(s => s.querySelector('h2')?.textContent === 'Times')"
        self.show("a", "b")
        assert all(p["time_ns"]["cold"] == (p["time_ns"]["n"] > 0) for p in self.run_json("a")["passes"] if p["ran"])
        assert not any(p["time_ns"]["cold"] for p in self.run_json("b")["passes"])
        heads = self.browser.evaluate(f"{TABLE}('Times')")[1][0]
        assert heads == ["pass", "a (cold)ms", "bms"] or [h.replace("ms", "") for h in heads] == ["pass", "a (cold)", "b"], heads
        text = self.browser.evaluate(charts + ".textContent")
        assert "a: cold, from a single round" in text and "Each frame: a (cold) " in text, text[:400]
        drawn = self.table("Times", 0)
        assert [row[0] for row in drawn] == [row[0] for row in self.table("Times", 1) if row[2] != "\u2013"], drawn
        bars = self.browser.evaluate(charts + ".querySelectorAll('table')[1].querySelector('tbody tr:last-child').querySelectorAll('td.bar').length")
        assert bars == 1, bars
        self.show("a")  # alone, they are drawn with their mark
        assert "Each frame: cold " in self.browser.evaluate(charts + ".textContent")
        assert len(self.table("Times", 0)) == len(self.table("Times", 1))
        self.browser.quiet()

    def shown(self, run):
        """The images of a run that a page shows: those of the picture's size and of half of it, also those of its errors."""
        record = self.run_json(run)
        return {i["name"] for owner in (*record["passes"], record.get("compared", {"images": []})) for i in owner["images"]
                if (i["width"], i["height"]) in ((96, 54), (48, 27)) and ".level" not in i["name"]}

    def test_pictures_are_whole(self):
        self.show("a")
        sizes = self.browser.evaluate("Promise.all([...document.querySelectorAll('main img')].map(i => i.decode().then(() => i.naturalWidth)))")
        names = self.browser.evaluate("[...document.querySelectorAll('main figcaption')].map(c => c.textContent.split(':')[0])")
        assert len(sizes) == len(names) and min(sizes) >= 96, sizes
        screen = self.shown("a")
        assert screen and set(names) == screen, screen ^ set(names)
        glint("report", self.path("a"), "-o", self.path("two.html"), "--images=travelled,composed")
        self.browser.show(self.path("two.html"))
        assert self.browser.evaluate("document.querySelectorAll('main img').length") == 3
        self.browser.quiet()

    def test_runs_stand_beside_each_other(self):
        self.show("a", "b")
        assert self.table("Parameters that differ") == [["cubemap_trace", "steps_hq", "24", "8"], ["blur", "", "plus", "–"],
                                               ["temporal", "", "rough", "–"]], self.table("Parameters that differ")
        captions = self.browser.evaluate("[...document.querySelectorAll('main figcaption')].map(c => c.textContent)")
        assert sum(c.startswith("a, composed") for c in captions) == sum(c.startswith("b, composed") for c in captions) == 2
        self.browser.quiet()

    def test_pictures_are_paired_by_name(self):
        """Run a has diagnostics, which b has not."""
        self.show("a", "b")
        rows = self.browser.evaluate(
            "[...[...document.querySelectorAll('main .pictures')].at(-1).children].map(e => [e.tagName, (e.querySelector('figcaption') || e).textContent])")
        assert [kind for kind, _ in rows] == ["H3", "FIGURE", "FIGURE"] * (len(rows) // 3), [kind for kind, _ in rows]
        absent = 0
        for (_, head), (_, first), (_, second) in zip(rows[::3], rows[1::3], rows[2::3]):
            name = head.split(": ")[1]
            assert first.startswith(f"a, {name}") and second.startswith(f"b, {name}"), (head, first, second)
            absent += second == f"b, {name}: not in b"
        made = {run: self.shown(run) for run in "ab"}
        assert absent == len(made["a"] - made["b"]) > 3 and len(rows) == 3 * len(made["a"] | made["b"]), (absent, len(rows))
        # a pair stands in one row, also in a narrow window
        tops = self.browser.evaluate("[...[...document.querySelectorAll('main .pictures')].at(-1).querySelectorAll('figure')].map(f => f.getBoundingClientRect().y)")
        assert tops[::2] == tops[1::2], tops
        self.browser.quiet()

    def test_a_shot_is_played_with_its_error_and_flicker(self):
        glint("sample", "room", "--light=4", "-o", self.path("s.exr"), "--size=64x36", "--cube-size=16", "--frames=3", "--truth=4")
        glint("replay", *(self.path(f"s.000{i}.exr") for i in (1, 2, 3)), "-p", PLAIN, "-o", self.path("shot"), "--against=truth")
        self.show("shot")
        rows = self.table("Error and flicker", 2)
        assert [r[:2] for r in rows] == [[str(i), f"s.000{i}"] for i in (1, 2, 3)], rows
        for i, row in enumerate(rows):  # errors are those that replay measured
            with open(self.path(f"shot/s.000{i + 1}/errors.json"), encoding="utf-8") as file:
                (everything,) = [s for s in json.load(file)["against_truth"]["image"]["surfaces"] if s["surfaces"] == "all"]
            assert abs(float(row[2]) - everything["clean_rmse"]) < 1e-3 and abs(float(row[4]) - everything["symmetric"]) < 1e-3, (row, everything)
        assert rows[0][5] == "\u2013" and all(float(r[5]) <= float(r[6]) for r in rows[1:]), rows
        worst = max(range(3), key=lambda i: float(rows[i][2]))
        assert "largest error" in rows[worst][9] and sum("largest flicker" in r[9] for r in rows) == 1, rows
        # the player goes to the worst frame and on, and the charts with it
        player = "document.querySelector('.player')"
        caption = f"{player}.querySelector('figcaption').textContent"
        self.browser.evaluate(f"[...{player}.querySelectorAll('button')].find(b => b.textContent.startsWith('largest error')).click()")
        assert self.browser.evaluate(caption).startswith(f"frame {worst + 1}: composed") and "largest error" in self.browser.evaluate(caption)
        assert self.browser.evaluate("document.querySelector('aside h4').textContent") == f"frame {worst + 1}"
        sources = set()
        for track in ("Final image", "Reflections", "Truth", "Error"):
            self.browser.evaluate(f"[...{player}.querySelectorAll('button')].find(b => b.textContent === '{track}').click()")
            assert self.browser.evaluate(f"{player}.querySelector('img').decode().then(() => {player}.querySelector('img').naturalWidth)") == 64
            sources.add(self.browser.evaluate(f"{player}.querySelector('img').src"))
        assert len(sources) == 4 and self.browser.evaluate(f"{player}.querySelectorAll('.ticks span').length") == 5
        seen = self.browser.evaluate(f"new Promise(done => {{ const seen = new Set(); {player}.querySelector('button').click(); "
                                     f"const look = () => {{ seen.add({caption}); seen.size < 3 ? setTimeout(look, 20) : done([...seen]); }}; look(); }})")
        assert len(seen) == 3, seen
        self.browser.evaluate(f"{player}.querySelector('button').click()")
        self.browser.quiet()
        # without its captures a shot says so, and shows how much it changes
        for i in (1, 2, 3):
            os.remove(self.path(f"s.000{i}.exr"))
        glint("report", self.path("shot"), "-o", self.path("alone.html"))
        self.browser.show(self.path("alone.html"))
        text = self.browser.evaluate("document.querySelector('main').textContent")
        assert "Not all frames have a truth" in text and "s.0001.exr" in text, text[:600]
        assert len(self.table("Error and flicker", 0)) == 2
        self.browser.quiet()
        assert "report it separately" in glint("report", self.path("a"), self.path("shot"), "-o", self.path("x.html"), status=2).stderr

    def test_errors_are_those_of_the_comparison(self):
        with open(os.path.join(self.path("a"), "errors.json"), encoding="utf-8") as file:
            (everything,) = [s for s in json.load(file)["against_truth"]["image"]["surfaces"] if s["surfaces"] == "all"]
        self.show("a")
        (report,) = [row for table in (0, 1) for row in self.table("Error of the reflection", table) if row[0] == "all" and len(row) > 5]
        assert int(report[1].replace("\u202f", "")) == everything["pixels"]
        assert abs(float(report[4]) - everything["rmse"]) < 1e-3, (report, everything)
        assert not os.path.exists(os.path.join(self.path("b"), "errors.json"))

    def test_a_reference_says_what_noise_is_left_and_what_it_assumed(self):
        small = self.path("small.exr")
        glint("sample", "mirror_box", "-o", small, "--size=32x18", "--cube-size=8")
        glint("reference", small, "-o", self.path("reference"), "--rays=16", "--sensitivity=16")
        reference = self.run_json("reference")["reference"]
        self.show("reference")
        assert "16 rays per pixel" in self.browser.evaluate("document.querySelector('main').textContent")
        noise = {row[0]: row for row in self.table("Reference")}
        for n in reference["noise"]:
            assert abs(float(noise[n["surfaces"]][3]) - n["error"]) <= 0.06 * n["error"], (noise, n)  # two digits at least
        changes = self.table("Reference", 1)
        assert [(c[0], c[1]) for c in changes] == [(c["slot"], c["parameter"]) for c in reference["sensitivity"]["rows"]]
        assert any(c["ran"] for c in reference["sensitivity"]["rows"])
        for report, c in zip(changes, reference["sensitivity"]["rows"]):
            assert (report[7] == "–") == (not c["ran"]), (report, c)
        self.browser.quiet()

    def test_classes_of_pixels_have_names_of_their_own(self):
        self.show("a")
        names = [row[0] for row in self.table("Error of the reflection", 2)]
        assert len(set(names)) == len(names) and "hit distance: farther" in names and "distance: farther" in names, names
        intervals = self.browser.evaluate("document.querySelectorAll('td.interval').length")
        assert intervals > len(names), intervals

    def test_a_point_of_a_sweep_shows_its_parameters_and_its_picture(self):
        swept = self.path("swept")
        glint("sweep", self.capture, "-o", swept, "--vary=cubemap_trace.steps_hq=8,24", "--vary=resolve.fog=false,true",
              "--reference=truth", "--repeat=1", "-p", PLAIN)
        with open(os.path.join(swept, "points.json"), encoding="utf-8") as file:
            points = {f"point {p['point']}": p for p in json.load(file)["points"]}
        assert len(points) == 4
        self.browser.show(os.path.join(swept, "index.html"))
        ring = """(() => { const r = [...document.querySelectorAll('.plot path[stroke][fill=none]')].map(e => e.getBoundingClientRect())
            .find(r => Math.abs(r.width - 18) < 2 && Math.abs(r.height - 18) < 2); return [r.x + r.width / 2, r.y + r.height / 2]; })()"""
        terms = """Object.fromEntries([...document.querySelector('aside').querySelectorAll('dt')].map(e => [e.textContent,
            e.nextSibling.textContent]))"""
        image = "document.querySelector('aside img').decode().then(() => document.querySelector('aside img').naturalWidth)"
        name = "document.querySelector('aside h4').textContent"
        self.browser.evaluate("document.querySelector('.plot').focus()")
        places = {}
        for _ in points:
            self.browser.key("ArrowRight")
            report, shown = self.browser.evaluate(name), self.browser.evaluate(terms)
            places[report] = self.browser.evaluate(ring)
            assert points[report]["values"].items() <= shown.items(), (points[report]["values"], shown)
            assert self.browser.evaluate(image) >= 96
        assert set(places) == set(points), places
        for x, y in places.values():
            self.browser.key("Escape")
            self.browser.click(x, y)
            # points may coincide
            at = places[self.browser.evaluate("document.querySelector('aside').firstChild.textContent")]
            assert max(abs(at[0] - x), abs(at[1] - y)) < 8, (at, x, y)
        self.browser.quiet()
        # the same page again, from the folder
        glint("report", swept, "-o", self.path("again.html"))
        with open(os.path.join(swept, "index.html"), "rb") as first, open(self.path("again.html"), "rb") as again:
            assert first.read() == again.read()

    def test_presets_beside_each_other_have_a_page(self):
        compared = self.compared()
        with open(os.path.join(compared, "table.json"), encoding="utf-8") as file:
            presets = json.load(file)["captures"][0]["presets"]
        self.browser.show(os.path.join(compared, "index.html"))
        assert self.browser.evaluate("[...document.querySelectorAll('h2')].map(e => e.textContent)") == [NAME]
        assert self.browser.evaluate("[...document.querySelectorAll('h3')].map(e => e.textContent)") == \
            ["Error against time", "Error by class", "End reasons of rays", "Reflections", "Its error, 0 (dark) to 1 (bright); grey: not compared", "Image"]
        (rows,) = [t for t in self.browser.evaluate(f"{TABLE}({json.dumps(NAME)})") if t[0][-1] == "notes"]
        for row, preset in zip(rows[1:], presets, strict=True):
            (everything,) = [s for s in preset["surfaces"] if s["surfaces"] == "all"]
            assert row[0] == preset["preset"] and abs(float(row[5]) - everything["symmetric"]) < 1e-4, (row, everything)
        # the truth has no error of its own, and this scene has no final image
        stages = self.browser.evaluate("[...document.querySelectorAll('.stage')].map(s => [...new Set([...s.querySelectorAll('option, .bar button')].map(o => o.textContent))])")
        assert [s[5:8] for s in (stages[0], stages[2])] == [["truth", "mafia3", "kf2"], ["without effects", "mafia3", "kf2"]], stages
        assert stages[1][:5] == ["Slider", "Side by side", "Flicker", "mafia3", "kf2"], stages
        self.browser.quiet()

    def test_presets_are_compared_pixel_by_pixel(self):
        compared = self.compared()
        with open(os.path.join(compared, "page.json"), encoding="utf-8") as file:
            assert all(picture["values"]["every"] == 1 for section in json.load(file)["sections"] for block in section["blocks"]
                       if "stage" in block for picture in block["stage"]["pictures"])
        self.browser.show(os.path.join(compared, "index.html"))
        stage = "document.querySelectorAll('.stage')[{}]"

        def values(number, x, y):
            """The values that the stage shows for a pixel: {preset: [value of each channel]}."""
            box = stage.format(number) + ".querySelector('.frame')"
            self.browser.evaluate(box + ".scrollIntoView()")
            left, top, width, height = self.browser.evaluate(f"(r => [r.x, r.y, r.width, r.height])({box}.getBoundingClientRect())")
            self.browser.point_at(left + (x + 0.5) / 96 * width, top + (y + 0.5) / 54 * height)
            self.browser.evaluate(f"new Promise(done => {{ const wait = () => {stage.format(number)}.querySelector('.readout th')?.textContent === '{x},{y}' ? done() : setTimeout(wait, 10); wait(); }})")
            rows = self.browser.evaluate(f"[...{stage.format(number)}.querySelectorAll('.readout tbody tr')].map(r => [...r.cells].slice(0, -1).map(c => c.textContent))")
            return {row[0]: [float(v.replace("\u2212", "-")) for v in row[1:4] if re.fullmatch("[-+0-9.e\u2212]+", v)] for row in rows}

        # the error is the symmetric one of docs/metrics.md, of the reflections that the page contains
        compared = 0
        for x, y in ((20, 40), (48, 30), (70, 45)):
            reflection, error = values(0, x, y), values(1, x, y)
            for preset in ("mafia3", "kf2"):
                if not any(reflection[preset]) or not error[preset]:
                    continue
                compared += 1
                expected = sum(abs(a - b) / (abs(a) + abs(b) + 0.05) for a, b in zip(reflection[preset], reflection["truth"])) / 3
                assert abs(error[preset][0] - expected) < 1e-5, (x, y, preset, error, expected)
        assert compared >= 3
        self.browser.evaluate(f"(s => {{ s.value = 1; s.dispatchEvent(new Event('change')); }})({stage.format(0)}.querySelectorAll('select')[0])")
        assert self.browser.evaluate(f"[...{stage.format(0)}.querySelectorAll('.tag')].map(t => t.textContent)") == ["mafia3", "kf2"]
        self.browser.quiet()

    def test_what_cannot_be_reported_is_named(self):
        assert "nowhere" in glint("report", self.path("nowhere"), "-o", self.path("x.html"), status=1).stderr
        assert "x.txt" in glint("report", self.path("a"), "-o", self.path("x.txt"), status=2).stderr
        os.makedirs(self.path("study"), exist_ok=True)
        with open(self.path("study/page.json"), "w", encoding="utf-8") as file:
            file.write('{"format": 2}')
        assert "format" in glint("report", self.path("study"), "-o", self.path("x.html"), status=1).stderr
        assert "report it separately" in glint("report", self.path("a"), self.path("study"), "-o", self.path("x.html"), status=2).stderr
        assert not os.path.exists(self.path("x.html"))


sys.exit(run_tests(Tests, "glint-report-"))
