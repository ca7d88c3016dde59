"""Pages of glint report in headless Chromium: page.py GLINT. Speaks TAP."""
import json
import os
import re
import struct
import subprocess
import sys
import xml.dom.minidom
import zlib

from browser import add_script, run_tests

GLINT = sys.argv[1]
HOSTILE = "</script><script>alert(1)</script><img src=x onerror=alert(2)>&quot;\"'`${alert(3)}"


def png(path, width, height, rows, level=9):
    """A picture, without anybody's library."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows), level)) + chunk(b"IEND", b""))


def glint(*arguments):
    return subprocess.run([GLINT, *arguments], capture_output=True, text=True)


def report(folder, document, name="page.html"):
    """Stores the document in its folder and writes its page."""
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "page.json"), "w", encoding="utf-8") as file:
        json.dump(document, file)
    out = os.path.join(folder, name)
    run = glint("report", folder, "-o", out)
    assert run.returncode == 0 and not run.stderr, run.stderr
    return out


def page(*blocks, title="T", facts=()):
    return {"format": 1, "title": title, "facts": list(facts), "sections": [{"title": "S", "blocks": list(blocks)}]}


def point(x, y, name, steps, picture):
    return {"x": x, "y": y, "low": y * 0.9, "high": y * 1.1, "name": name, "values": [["screen_trace.steps", steps, ""]],
            "pictures": [{"file": picture, "caption": f"picture of {name}"}]}


def chart(points, **more):
    return {"chart": {"title": "error against time", "x": {"name": "time", "unit": "ms", "scale": "log"},
                      "y": {"name": "error", "scale": "log"}, "series": [{"name": "front", "kind": "front", "points": points}],
                      **more}}


# The middle of the marks that stand for points, from the left; ECharts draws them as paths of the symbol's size.
MARKS = """[...document.querySelectorAll('.plot path')].map(e => e.getBoundingClientRect())
    .filter(r => Math.abs(r.width - 9) < 1.6 && Math.abs(r.width - r.height) < 0.6 && r.y > document.querySelector('.plot').getBoundingClientRect().y + 40)
    .map(r => [r.x + r.width / 2, r.y + r.height / 2]).sort((a, b) => a[0] - b[0])"""
TEXT_OF = "document.querySelector('{}').textContent"


class Tests:
    def __init__(self, folder, browser):
        self.folder, self.browser = folder, browser
        png(os.path.join(folder, "red.png"), 40, 30, [b"\xff\0\0" * 40] * 30)
        png(os.path.join(folder, "blue.png"), 40, 30, [b"\0\0\xff" * 40] * 30)

    def scatter(self):
        points = [point(1, 0.1, "few", 8, "red.png"), point(4, 0.02, "many", 64, "blue.png")]
        self.browser.show(report(self.folder, page(chart(points))))
        marks = self.browser.evaluate(MARKS)
        assert len(marks) == 2, marks
        return marks

    def shown(self):
        return self.browser.evaluate(TEXT_OF.format("aside"))

    def color_of_picture(self):
        return self.browser.evaluate("""(async () => {
            const image = document.querySelector('aside img'), canvas = document.createElement('canvas');
            await image.decode();
            canvas.getContext('2d').drawImage(image, 0, 0);
            return [...canvas.getContext('2d').getImageData(5, 5, 1, 1).data].slice(0, 3);
        })()""")

    def test_a_click_on_a_point_shows_its_parameters_and_its_picture(self):
        marks = self.scatter()
        assert "64" not in self.shown()
        self.browser.click(*marks[1])
        assert "many" in self.shown() and "screen_trace.steps64" in self.shown(), self.shown()
        assert self.color_of_picture() == [0, 0, 255], self.color_of_picture()
        # it stays when the pointer leaves; another point replaces it, and it comes back
        self.browser.point_at(*marks[0])
        assert "few" in self.shown() and self.color_of_picture() == [255, 0, 0]
        self.browser.point_at(5, 5)
        assert "many" in self.shown(), self.shown()
        # kept while another one is selected: differences are marked, and the enlarged picture flips in place
        differing = "[...document.querySelectorAll('aside .differs')].map(e => e.textContent).join()"
        assert self.browser.evaluate(differing) == ""
        self.browser.click(*marks[0])
        assert self.browser.evaluate(differing) == "8"
        self.browser.evaluate("document.querySelector('aside figure button').click()")
        caption = TEXT_OF.format("dialog p")
        assert "picture of few" in self.browser.evaluate(caption)
        self.browser.key("ArrowRight")
        assert "picture of many" in self.browser.evaluate(caption)
        self.browser.quiet()

    def test_a_point_is_kept_in_every_chart_that_has_it(self):
        few, many = point(1, 0.1, "few", 8, "red.png"), point(4, 0.02, "many", 64, "blue.png")
        self.browser.show(report(self.folder, page(chart([few, many]), chart([{**many, "x": 2}, {**few, "x": 9}]), chart([[1, 1], [2, 1]]))))
        self.browser.evaluate("document.querySelector('.plot').focus()")
        for key in ("ArrowRight", "ArrowRight", "Enter"):
            self.browser.key(key)
        output = self.browser.evaluate("[...document.querySelectorAll('aside h4')].map(e => e.textContent)")
        assert output == ["many", "many"], output
        lines = self.browser.evaluate("[...document.querySelectorAll('tr.chosen')].map(e => e.cells[0].textContent)")
        assert lines == ["many", "many"], lines
        self.browser.key("Escape")
        assert self.browser.evaluate("document.querySelectorAll('aside h4, tr.chosen').length") == 0
        self.browser.quiet()

    def test_a_point_under_the_line_of_a_front_can_be_reached(self):
        block = chart([point(1, 0.1, "few", 8, "red.png"), point(4, 0.02, "many", 64, "blue.png")])
        block["chart"]["series"].insert(0, {"name": "beaten", "kind": "scatter", "muted": True, "points": [point(2, 0.1, "same", 9, "red.png")]})
        self.browser.show(report(self.folder, page(block)))
        x, y = self.browser.evaluate(MARKS.replace("r.width - 9", "r.width - 6"))[0]
        self.browser.click(x, y)
        assert "same" in self.shown(), self.shown()
        self.browser.quiet()

    def test_keys_reach_every_point(self):
        self.scatter()
        self.browser.evaluate("document.querySelector('.plot').focus()")
        self.browser.key("ArrowRight")
        assert "few" in self.shown()
        self.browser.key("ArrowRight")
        assert "many" in self.shown()
        self.browser.key("Enter")
        self.browser.key("ArrowLeft")
        assert "few" in self.shown()
        self.browser.key("Escape")
        assert "few" not in self.shown() and "many" not in self.shown()
        self.browser.quiet()

    def scripted(self, document, script):
        """A page with one more script, as a page of its own would have it."""
        out = report(self.folder, document)
        add_script(out, script)
        self.browser.show(out)

    def test_a_chart_is_replaced_under_the_focus_and_says_what_was_chosen(self):
        first = chart([point(1, 0.1, "few", 8, "red.png"), point(4, 0.02, "many", 64, "blue.png")])["chart"]
        later = chart([point(2, 0.1, "half", 16, "red.png"), point(4, 0.03, "many", 65, "blue.png"), point(5, 0.01, "most", 99, "red.png")], title="later")["chart"]
        self.scripted(page(), f"""const own = glintParts.page(), chosen = []; let before; const plot = () => document.querySelector('.plot');
            const made = glintParts.chartElement({json.dumps(first)}, own, p => chosen.push(p.name));
            document.querySelector('main').append(made);
            made.draw();""")
        ask = self.browser.evaluate
        ask("plot().focus()")
        for key in ("ArrowRight", "ArrowRight", "Enter"):
            self.browser.key(key)
        assert ask("chosen.join()") == "many" and "many" in self.shown() and "64" in self.shown(), self.shown()
        ask(f"before = plot(), made.replace({json.dumps(later)})")
        assert ask("plot() === before && document.activeElement === before && own.charts.length === 1")
        assert "many" in self.shown() and "65" in self.shown() and ask(TEXT_OF.format("main h3")) == "later", self.shown()
        assert ask("document.querySelector('tr.chosen').cells[0].textContent") == "many" and len(ask(MARKS.replace("r.width - 9", "r.width - 8"))) == 3
        self.browser.key("ArrowRight")
        assert "most" in self.shown()
        self.browser.key("Enter")
        assert ask("chosen.join()") == "many,most"
        # a row of the table keeps it too; a chart may lose what it had beside it, and come back
        ask("made.querySelector('details').open = true, [...made.querySelectorAll('tbody tr')].find(r => r.cells[0].textContent === 'many').focus()")
        ask(f"made.replace({json.dumps(first)})")
        assert ask("document.activeElement.cells[0].textContent") == "many"
        ask(f"made.replace({json.dumps(chart([[1, 0.1]])['chart'])})")
        assert ask("made.querySelector('aside') === null && made.querySelectorAll('tbody tr').length === 1")
        ask(f"made.replace({json.dumps(chart([])['chart'])}), plot().focus()")
        self.browser.key("ArrowRight")
        self.browser.key("Enter")
        assert ask("made.querySelector('table') === null && chosen.join()") == "many,most"
        ask(f"made.replace({json.dumps(first)})")
        assert "Point at a mark" in self.shown() and ask("made.querySelectorAll('tbody tr').length") == 2
        self.browser.quiet()

    def test_names_of_strangers_stay_names(self):
        where = [HOSTILE + place for place in ("t", "f", "g", "c", "u", "x", "n", "v", "p", "m", "k", "b")]
        t, f, g, c, u, x, n, v, p, m, k, b = where
        blocks = [{"text": b}, {"note": b}, {"code": b}, {"table": {"columns": [{"name": c, "unit": u, "help": c}], "rows": [[x], [{"text": x, "value": 1}]]}},
                  {"pictures": [{"file": "red.png", "caption": p}]},
                  {"chart": {"title": t, "x": {"name": k, "unit": u}, "y": {"scale": "category", "categories": [k, n]}, "marks": [{"x": 1, "label": m}],
                             "series": [{"name": n, "kind": "bar", "points": [{"x": 1, "y": 0, "name": v, "values": [[v, v, v]], "pictures": [{"file": "red.png", "caption": p}]}]},
                                        {"name": v, "kind": "bar", "points": [[2, 1]]}]}}]
        out = report(self.folder, page(*blocks, title=t, facts=[[f, g]]))
        with open(out, encoding="utf-8") as file:
            assert "alert(1)</script>" not in file.read()
        self.browser.show(out)
        self.browser.evaluate("document.querySelector('.plot').focus()")
        self.browser.key("ArrowRight")
        assert v in self.shown(), self.shown()
        self.browser.evaluate("document.querySelectorAll('figure button').forEach(b => b.click())")
        text = self.browser.evaluate("document.body.textContent")
        for name in where:
            assert name in text, name
        assert self.browser.evaluate("document.title") == t
        assert self.browser.evaluate("document.querySelectorAll('main script, header script, main [onerror], dialog [onerror]').length") == 0
        self.browser.quiet()

    def test_scripts_that_are_not_the_page_s_own_do_not_run(self):
        out = report(self.folder, page({"text": "x"}))
        with open(out, encoding="utf-8") as file:
            text = file.read()
        with open(out, "w", encoding="utf-8") as file:
            file.write(text.replace("</body>", "<script>window.mine = 1</script><img src='http://127.0.0.1:1/x.png'></body>"))
        self.browser.open(out)
        assert self.browser.evaluate("window.mine === undefined")
        assert any("Content Security Policy" in m for m in self.browser.messages), self.browser.messages

    def test_tables_sort_by_number(self):
        rows = [["a", 10], ["b", {"value": 9.5, "low": 9, "high": 10}], ["c", None], ["d", 100]]
        table = {"table": {"columns": [{"name": "name"}, {"name": "time", "unit": "ms", "bar": True}], "rows": rows}}
        self.browser.show(report(self.folder, page(table)))
        order = "[...document.querySelectorAll('tbody tr')].map(r => r.cells[0].textContent).join('')"
        assert self.browser.evaluate(order) == "abcd"
        self.browser.evaluate("document.querySelectorAll('th button')[1].click()")
        assert self.browser.evaluate(order) == "badc"
        self.browser.evaluate("document.querySelectorAll('th button')[1].click()")
        assert self.browser.evaluate(order) == "dabc"
        # numbers are right-aligned
        ends = self.browser.evaluate("[...new Set([...document.querySelectorAll('td.number')].map(e => e.getBoundingClientRect().right))].length")
        assert ends == 1, ends
        self.browser.quiet()

    def test_numbers_keep_the_digits_that_tell_them_apart(self):
        columns = [([8, 32, 1000], ["8", "32", "1\u202f000"]), ([0.5, 1, 1.5], ["0.5", "1.0", "1.5"]),
                   ([1234.5678, 0.00321, 0], ["1\u202f235", "0.0032", "0"]), ([0.123456, 0.2, -0.05], ["0.1235", "0.2000", "\u22120.0500"]),
                   ([1e-7, 3e-7, 2e-7], ["1e\u22127", "3e\u22127", "2e\u22127"]), ([True, "a", None], ["yes", "a", "\u2013"])]
        table = {"columns": [{"name": str(i)} for i in range(len(columns))], "rows": [list(row) for row in zip(*(c[0] for c in columns))]}
        self.browser.show(report(self.folder, page({"table": table})))
        for i, (_, wanted) in enumerate(columns):
            output = self.browser.evaluate(f"[...document.querySelectorAll('tbody tr')].map(r => r.cells[{i}].textContent)")
            assert output == wanted, (output, wanted)

    def test_a_chart_as_svg_is_xml(self):
        points = [point(1, 0.1, HOSTILE, 8, "red.png"), point(4, 0.02, "many", 64, "blue.png"), [0, 0.5], [2, None]]
        odd = HOSTILE + "\u0001\U0001f600\u00e9]]>"
        block = chart(points, title=odd, marks=[{"y": 0.011, "label": odd}, {"x": 4, "y": 0.02, "label": odd}])
        block["chart"]["series"].append({"name": odd, "kind": "scatter", "muted": True, "points": [[2, 0.5]]})
        report(self.folder, page(block))
        out = os.path.join(self.folder, "chart.svg")
        run = glint("report", self.folder, "-o", out)
        assert run.returncode == 0, run.stderr
        svg = xml.dom.minidom.parse(out)
        texts = ["".join(c.data for c in e.childNodes) for e in svg.getElementsByTagName("text")]
        assert any(t.startswith(HOSTILE) and t.endswith("\U0001f600\u00e9]]>") for t in texts), texts
        assert not svg.getElementsByTagName("script")
        assert not [n for e in svg.getElementsByTagName("*") for n in e.attributes.keys() if n.startswith("on")]

    def test_marks_stand_at_their_values(self):
        """The line of a mark is at its value on the axis, compared with two points on either side, in the file."""
        points = [[1, 0.012], [2, 0.018]]
        block = {"chart": {"x": {"name": "x"}, "y": {"name": "y"}, "series": [{"name": "s", "kind": "line", "points": points}],
                           "marks": [{"y": 0.015}]}}
        report(self.folder, page(block))
        out = os.path.join(self.folder, "marks.svg")
        assert glint("report", self.folder, "-o", out).returncode == 0
        paths = [e for e in xml.dom.minidom.parse(out).getElementsByTagName("path")]
        (line,) = [e.getAttribute("d") for e in paths if e.getAttribute("stroke-dasharray")]
        (curve,) = [e.getAttribute("d") for e in paths if e.getAttribute("stroke-width") == "2" and e.getAttribute("fill") == "none"]
        heights = [float(p.split()[1]) for p in curve[1:].split("L")]
        mark = float(line[1:].split("L")[0].split()[1])
        assert abs(mark - sum(heights) / 2) <= 1, (mark, heights)  # 1: lines are snapped to whole pixels

    def test_intervals_stand_on_their_bars(self):
        values = [[3, 2, 4], [1, 5, 2]]
        series = [{"name": str(k), "kind": "bar", "points": [{"x": i, "y": y, "low": y - 0.5, "high": y + 0.5} for i, y in enumerate(v)]}
                  for k, v in enumerate(values)]
        block = {"chart": {"x": {"scale": "category", "categories": ["a", "b", "c"]}, "y": {"name": "y"}, "series": series}}
        report(self.folder, page(block))
        out = os.path.join(self.folder, "bars.svg")
        assert glint("report", self.folder, "-o", out).returncode == 0
        paths = [(e.getAttribute("d"), e.getAttribute("fill")) for e in xml.dom.minidom.parse(out).getElementsByTagName("path")]
        # a bar: from a lower corner, across, up by its height; an interval: three strokes, the first from end to end
        corners = [[float(c) for c in re.findall(r"[-0-9.]+", d)] for d, fill in paths
                   if re.fullmatch(r"M[-0-9. ]+l[-0-9. ]+l0 [-0-9. ]+l[-0-9. ]+Z", d) and fill in ("#0072b2", "#d55e00")]
        strokes = [[float(c) for c in re.findall(r"[-0-9.]+", d)] for d, fill in paths if d.count("M") == 3]
        bars = sorted((x + across / 2, y + up) for x, y, across, _, _, up, *_ in corners)
        ends = sorted((c[0], (c[1] + c[3]) / 2) for c in strokes)
        assert len(bars) == len(ends) == 6, (bars, ends)
        for bar, end in zip(bars, ends):
            assert abs(bar[0] - end[0]) < 1 and abs(bar[1] - end[1]) < 1, (bars, ends)  # 1: whole pixels

    def test_points_that_a_logarithm_lacks_are_counted(self):
        self.browser.show(report(self.folder, page(chart([[1, 0.1], [0, 0.2], [-1, 0.2], [3, 0.05]]))))
        assert "2 points without a place on these axes" in self.browser.evaluate(TEXT_OF.format("main"))
        self.browser.quiet()

    def test_a_page_of_200_pictures_can_be_sent(self):
        folder = os.path.join(self.folder, "many")
        os.makedirs(folder)
        points = []
        for i in range(200):
            # noise is the worst case for any encoder
            png(os.path.join(folder, f"{i}.png"), 320, 180, [os.urandom(960) for _ in range(180)], 0)
            points.append(point(1 + i, 1 / (1 + i), f"p{i}", i, f"{i}.png"))
        out = report(folder, page(chart(points)))
        assert os.path.getsize(out) < 20e6, os.path.getsize(out)
        self.browser.show(out)
        self.browser.evaluate("document.querySelector('.plot').focus()")
        self.browser.key("ArrowLeft")
        assert "p199" in self.shown()
        assert self.browser.evaluate("document.querySelector('aside img').decode().then(() => document.querySelector('aside img').naturalWidth)") >= 80
        self.browser.quiet()

    def test_pictures_come_from_the_folder_alone(self):
        folder = os.path.join(self.folder, "inside")
        os.makedirs(folder)
        os.symlink(os.path.join(self.folder, "red.png"), os.path.join(folder, "link.png"))
        for file in ("../red.png", os.path.join(self.folder, "red.png"), "link.png", "nothing.png", "page.json"):
            with open(os.path.join(folder, "page.json"), "w", encoding="utf-8") as out:
                json.dump(page({"pictures": [{"file": file, "caption": ""}]}), out)
            run = glint("report", folder, "-o", os.path.join(folder, "r.html"))
            assert run.returncode != 0 and file in run.stderr, (file, run.stderr)
            assert sorted(os.listdir(folder)) == ["link.png", "page.json"], os.listdir(folder)

    def test_nonsense_leaves_the_rest(self):
        charts = [5, {"series": [None, {"points": [None, "x", {}, {"x": 1, "y": "a"}, [1, 2]]}]},
                  {"x": {"scale": "log", "min": 5, "max": 5}, "series": [{"kind": "nothing", "points": [[1, 2]]}], "marks": [None, {"x": "1"}]},
                  {"y": {"scale": "category"}, "series": [{"kind": "bar", "points": [[1, 7]]}], "height": 1e9}]
        blocks = [None, 3, *({"chart": c} for c in charts), {"table": {"rows": [None, [{}]]}}, {"table": 1}, {"pictures": [None, 1]},
                  {"note": [1]}, {"text": "the last one"}]
        document = page(*blocks)
        document["sections"].append(None)
        self.browser.show(report(self.folder, document))
        assert "the last one" in self.browser.evaluate(TEXT_OF.format("main"))
        self.browser.quiet()
        for i in range(1, 5):
            out = os.path.join(self.folder, "nonsense.svg")
            run = glint("report", self.folder, "--chart", str(i), "-o", out)
            assert run.returncode == 0, run.stderr
            xml.dom.minidom.parse(out)
        assert "the page has 4" in glint("report", self.folder, "--chart=5", "-o", out).stderr

    def test_dark_and_light(self):
        ground = "getComputedStyle(document.body).backgroundColor"
        self.browser.look(dark=True)
        self.scatter()
        dark = self.browser.evaluate(ground)
        self.browser.evaluate("document.getElementById('look').click()")
        light = self.browser.evaluate(ground)
        self.browser.look(dark=False)
        assert dark == "rgb(22, 24, 29)" and light == "rgb(255, 255, 255)", (dark, light)
        self.browser.quiet()


sys.exit(run_tests(Tests, "glint-page-"))
