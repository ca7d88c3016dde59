"""The interface of glint live: each request of docs/live.md with each of its members, bad input, and answers against the commands whose work they
do: live_api.py GLINT. Speaks TAP."""
import filecmp
import http.client
import json
import math
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time

import live_contract
import tap
from live import Live, Refused
from pictures import read_png
from tap import glint, programs

GLINT = sys.argv[1]
TUNE = pathlib.Path(__file__).resolve().parents[2] / "tools/python/tune_live.py"
SIZE = (64, 36)
OTHER = {"set": {"cubemap_trace.steps_hq": 4}}
LONG = {"set": {"pipeline.rays": 1024}}
PIXEL = {"x": 20, "y": 25}


def refused(status, code, words, request, *arguments, **members):
    try:
        answer = request(*arguments, **members)
    except Refused as refusal:
        said = (refusal.status, refusal.code) == (status, code) and words in refusal.message
        assert said, (arguments, members, refusal, words)
        return
    raise AssertionError((arguments, members, str(answer)[:300]))


def close(a, b):
    """Equal, but that commands print nine digits of a value."""
    if isinstance(a, dict):
        return isinstance(b, dict) and a.keys() == b.keys() and all(close(a[k], b[k]) for k in a)
    if isinstance(a, list):
        return isinstance(b, list) and len(a) == len(b) and all(map(close, a, b))
    if isinstance(a, float) or isinstance(b, float):
        return a == b or (a is not None and b is not None and math.isclose(a, b, rel_tol=2e-8))
    return a == b


def texels(path, part, out):
    """Rows of texels of a part of an EXR file, by oiiotool."""
    words = ["oiiotool", "--native", path, "--subimage", str(part), "-o", out]
    subprocess.run(words, check=True, capture_output=True, env=programs.ENVIRONMENT)
    text = subprocess.run(["oiiotool", "--native", "--dumpdata", out], check=True, capture_output=True, text=True, env=programs.ENVIRONMENT).stdout
    found = {(int(x), int(y)): [float(v) for v in values.split()] for x, y, values in re.findall(r"Pixel \((\d+), (\d+)\): ([^\n(]+)", text)}
    width, height = (max(k) + 1 for k in zip(*found))
    return [[found[x, y] for x in range(width)] for y in range(height)]


def same_runs(a, b):
    names = sorted(p.name for p in a.glob("*.exr"))
    assert names and names == sorted(p.name for p in b.glob("*.exr")), (names, a, b)
    return all(filecmp.cmp(a / n, b / n, shallow=False) for n in names)


class Folders:
    """A server's private folders, of which none may be left."""

    def __init__(self, work):
        self.path = pathlib.Path(tempfile.mkdtemp(dir=work))

    def environment(self):
        return {**os.environ, "TMPDIR": str(self.path)}

    def left(self):
        return [p.name for p in self.path.iterdir()]


class Tests:
    def __init__(self, folder):
        self.folder = folder
        self.capture = folder / "street.exr"
        glint("sample", "street", "--light=1", "-o", str(self.capture), "--size", "64x36", "--cube-size", "16", "--truth", "1")
        self.live = Live(GLINT, self.capture, "-o", folder / "runs")
        self.get, self.post = self.live.get, self.live.post
        self.a, self.b = self.post("run", state={}), self.post("run", state=OTHER)
        self.post("write", state={}, name="a")
        self.post("write", state=OTHER, name="b")
        self.written = {"a": folder / "runs/a", "b": folder / "runs/b"}

    def picture(self, image, run=None, what="picture", **values):
        more = "".join(f"&{name}={value}" for name, value in values.items())
        return self.get(f"{what}?run={run or self.a['run']}&image={image}{more}")

    def raw(self, *arguments, **values):
        """The head of a raw picture, and rows of its pixels."""
        data = self.picture(*arguments, **values, format="raw")
        length = int.from_bytes(data[:4], "little")
        head = json.loads(data[4:4 + length])
        pixels = data[4 + length:]
        width, height = head["width"], head["height"]
        assert length % 4 == 0 and len(pixels) == 4 * width * height, (head, len(data))
        return head, [[tuple(pixels[4 * (y * width + x):][:3]) for x in range(width)] for y in range(height)]

    # ---- Members ----

    def test_answers_have_the_documented_members(self):
        state, client = {}, "tests"
        bodies = {"pipeline": {"state": state}, "run": {"state": state, "draft": False, "quick": False, "urgent": False, "client": client},
                  "values": {**PIXEL, "size": SIZE, "of": [{"run": self.a["run"], "image": "composed"}, {"run": self.a["run"], "image": "nothing"}]},
                  "answer": {"state": state, "effect": "reflection", "of": "truth", "client": client},
                  "figures": {"state": state, "effect": "reflection", "against": "truth", "metrics": ["rmse"], "rounds": 1, "client": client},
                  "probe": {"state": state, **PIXEL, "reference": False, "client": client}, "preset": {"state": state, "name": "mine"},
                  "report": {"a": state, "b": OTHER, "client": client}, "write": {"state": state, "name": "members", "client": client}}
        requests = live_contract.requests()
        assert {n for n, r in requests.items() if r.method == "POST"} == set(bodies), requests.keys()
        for name, request in requests.items():
            if name in ("picture", "difference", "events"):
                continue  # no JSON; tested below
            assert sorted(request.body) == sorted(bodies.get(name, {})), (name, request.body)
            answer = self.live.ask(request.method, name, bodies.get(name))
            found = live_contract.differences(request.answer, answer) if name != "report" else []
            assert not found, (name, found[:5])
            assert request.answer or name == "report", name
        members = live_contract.state_members()
        for answer in (self.a, self.b, self.post("answer", **bodies["answer"]), {"state": self.get("registry")["start"]}):
            assert list(answer["state"]) == members, (answer["state"], members)

    def test_the_registry_is_that_of_the_commands(self):
        registry = self.get("registry")
        passes = json.loads(glint("passes", "--json").stdout)
        assert registry["passes"] == passes["passes"] and registry["effects"] == passes["effects"]
        assert registry["version"] == 1 and registry["out"] is True and registry["reference"] is None
        assert registry["captures"] == [{"name": "street.exr", "path": str(self.capture), "frame": 1, "cut": False, "size": list(SIZE),
                                         "draft": [32, 18], "truth": ["reflection"]}], registry["captures"]
        assert registry["tool"] in glint("--version").stdout

    def test_events_are_lines_of_json(self):
        connection = http.client.HTTPConnection(self.live.host, timeout=60)
        connection.request("GET", "/api/v1/events", headers={"Authorization": f"Bearer {self.live.token}"})
        lines = connection.getresponse()
        self.post("run", state={"set": {"cubemap_trace.steps_hq": 5}}, client="someone")
        seen = []
        while not seen or seen[-1]["event"] != "idle":
            seen.append(json.loads(lines.readline()))
        connection.close()
        progress = [e for e in seen if e["event"] == "progress"]
        assert progress and all(set(e) == {"event", "client", "what", "done"} and e["client"] == "someone" and 0 <= e["done"] <= 1 for e in progress), seen

    # ---- Bad input ----

    def test_states_are_checked(self):
        for name in ("pipeline", "run", "answer", "figures", "probe", "preset", "write"):
            refused(400, "usage", 'no member "state"', self.post, name)
            for bad in ([], "x", 7, None, True, [{}]):
                refused(400, "usage", "state: expected an object", self.post, name, state=bad)
        for state, words in (({"sett": {}}, "did you mean set"), ({"capture": 1}, "0 to 0"), ({"capture": -1}, "0 to 0"), ({"capture": 0.5}, "capture"),
                             ({"capture": 1 << 62}, "capture"), ({"capture": "0"}, "capture"), ({"preset": "mafia4"}, "did you mean"),
                             ({"preset": "/etc/passwd"}, "no preset"), ({"preset": 3}, "preset"), ({"use": []}, "use: expected"), ({"use": {"blur": 1}}, "blur"),
                             ({"use": {"blurr": "plus"}}, "blur"), ({"use": {"blur": "pluss"}}, "plus"), ({"set": "x"}, "set: expected"),
                             ({"set": {"cubemap_trace.steps_hq": 1e99}}, "expected 1 to"), ({"set": {"cubemap_trace.steps_hq": -1}}, "expected 1 to"),
                             ({"set": {"cubemap_trace.steps_hq": 4.5}}, "steps_hq"), ({"set": {"cubemap_trace.steps_hq": "NaN"}}, "steps_hq"),
                             ({"set": {"compose.intensity": "nan"}}, "intensity"), ({"set": {"compose.intensity": "inf"}}, "intensity"),
                             ({"set": {"compose.intensity": "1e999"}}, "intensity"), ({"set": {"compose.intensity": None}}, "intensity"),
                             ({"set": {"compose.intensity": [1]}}, "intensity"), ({"set": {"no.thing": 1}}, "no slot"), ({"set": {"": 1}}, ""),
                             ({"set": {"compose.intensity=1 --shader": 1}}, "intensity"), ({"set": {"cubemap_trace." + "x" * 500: 1}}, "cubemap_trace"),
                             ({"skip": "blur"}, "skip: expected"), ({"skip": [1]}, "skip: expected"), ({"force": ["blurr"]}, "blur"), ({"force": {}}, "force")):
            for request in ("pipeline", "run"):
                refused(400, "usage", words, self.post, request, state=state)
        # these are JSON for no parser but Python's
        for text in ('{"state": {"set": {"compose.intensity": NaN}}}', '{"state": {"set": {"compose.intensity": 1e999}}}', "[]", '"x"', "", '{"state": {}', "\xff"):
            connection = http.client.HTTPConnection(self.live.host, timeout=60)
            connection.request("POST", "/api/v1/run", text.encode("latin-1"), {"Authorization": f"Bearer {self.live.token}"})
            answer = connection.getresponse()
            error = json.loads(answer.read())
            assert answer.status == 400 and error["code"] in ("format", "usage"), (text, answer.status, error)
            connection.close()

    def test_members_of_another_type_are_refused(self):
        wrong = {"run": {"draft": 1, "urgent": "yes", "quick": None, "client": 5}, "answer": {"effect": 3, "of": "both", "client": []},
                 "figures": {"effect": "reflections", "against": "ref", "metrics": "rmse", "rounds": 101, "client": {}}, "probe": {"x": 64, "y": 36, "reference": "no"},
                 "preset": {"name": 3}, "write": {"name": ["x"]}}
        wrong_too = {"answer": {"of": None, "effect": ""}, "figures": {"metrics": ["rmsee"], "rounds": -1, "against": 7}, "run": {"draft": "", "client": None},
                     "probe": {"x": -1, "y": 1.5}}
        right = {"answer": {"effect": "reflection", "of": "truth"}, "figures": {"effect": "reflection"}, "probe": PIXEL, "preset": {"name": "x"}, "write": {"name": "x"}}
        for table in (wrong, wrong_too):
            for request, members in table.items():
                for name, value in members.items():
                    refused(400, "usage", "", self.post, request, **{"state": {}, **right.get(request, {}), name: value})
        for members in ({"x": 1 << 40, "y": 0}, {"x": "1", "y": 0}, {"y": 0}):
            refused(400, "usage", "x: expected a whole number", self.post, "probe", state={}, **members)
        refused(400, "usage", '"b"', self.post, "report", a={})
        refused(400, "usage", "state: expected an object", self.post, "report", a={}, b=3)
        assert not (self.folder / "runs/x").exists()

    def test_values_outside_are_refused(self):
        of = [{"run": self.a["run"], "image": "composed"}]
        for bad in ({"x": 64}, {"y": 36}, {"x": -1}, {"x": 1.5}, {"x": "1"}, {"size": [0, 0]}, {"size": [64]}, {"size": [64.5, 36]}, {"size": "64x36"}, {"of": 9 * of},
                    {"of": "composed"}, {"of": None}):
            refused(400, "usage", "expected", self.post, "values", **{**PIXEL, "size": SIZE, "of": of, **bad})
        answers = self.post("values", **PIXEL, size=SIZE, of=[{}, 3, {"run": "0" * 16, "image": "composed"}, {"run": self.a["run"]}, of[0]])["values"]
        assert ["error" in a for a in answers] == [True, True, True, True, False], answers

    def test_a_value_without_a_texel_keeps_its_place(self):
        # a message that is cut within a letter is no UTF-8
        answers = self.post("values", **PIXEL, size=SIZE, of=[{"run": "0" * 16, "image": "a" + 60 * "é"}, {"run": self.a["run"], "image": "composed"}])["values"]
        assert ["error" in a for a in answers] == [True, False] and "no run" in answers[0]["error"], answers

    def test_pictures_of_nothing_are_refused(self):
        run = self.a["run"]
        for query in ("", f"run={run}", "image=composed", "run=&image=composed", "run=0123456789abcdef&image=composed", f"run={run}&image=nothing", f"run={'x' * 8000}&image=composed",
                      f"run={run}&image=../../../../etc/passwd", f"run={run}&image=composed.level1", f"run={run}&image={'%20' * 400}"):
            for what in ("picture?", f"difference?other={run}&"):
                refused(400, "usage", "", self.get, what + query)
        for values in ("exposure=nan", "exposure=inf", "exposure=1e999", "exposure=1%202", "exposure=x", "kind=colour", "low=1", "high=1", "low=2&high=1", "low=1&high=1",
                       "low=nan&high=1", "scale=cubic", "format=exr", "every=0", "every=65", "every=1.5", "every=nan", "display=nothing", "view=nothing"):
            refused(400, "usage", values.split("=")[0].split("&")[0] if "play" not in values and "view" not in values else "", self.get, f"picture?run={run}&image=composed&{values}")
        refused(400, "usage", "", self.get, f"difference?run={run}&other=0123&image=composed")
        refused(400, "usage", "cannot be compared", self.get, f"difference?run={run}&other={run}&image=composed&other_image=cubemap_color")

    # ---- What answers say is what the commands say ----

    def test_pictures_are_those_of_view(self):
        shown = ((["composed"], {}), (["composed", "--exposure", "2"], {"exposure": 2}), (["composed", "--display", "sRGB", "--view", "raw"], {"display": "sRGB", "view": "raw"}),
                 (["travelled"], {}), (["travelled", "--range", "2,30", "--scale", "linear"], {"low": 2, "high": 30, "scale": "linear"}), (["cubemap_index"], {}),
                 (["normal_half"], {}), (["composed", "--as", "raw"], {"kind": "raw"}), (["cubemap_color_mips"], {}), (["cubemap_color_mips.level1"], {}))
        for words, values in shown:
            file = self.folder / "view.png"
            glint("view", str(self.written["a"]), "--image", *words, "--no-legend", "-o", str(file))
            expected = read_png(file)
            assert self.picture(words[0], **values) == file.read_bytes(), words
            assert self.raw(words[0], **values)[1] == expected and len({p for row in expected for p in row}) > 3, words
        head, few = self.raw("composed", every=3)
        whole = self.raw("composed")[1]
        shape = live_contract.raw_head()
        assert few == [row[::3] for row in whole[::3]] and list(head) == list(shape), (head, shape)

    def test_drafts_and_quick_runs_are_those_of_replay(self):
        half, out = str(self.folder / "half.exr"), self.folder / "view.png"
        glint("crop", str(self.capture), "--every", "2", "-o", half)
        for name, members, capture, size in (("quick", {"quick": True}, str(self.capture), SIZE), ("draft", {"draft": True}, half, (32, 18))):
            run = self.post("run", state={"set": {"cubemap_trace.steps_hq": 9}}, **members)
            assert run["size"] == list(size) and run["draft"] == (name == "draft") and any(p["quick"] for p in run["passes"]) == (name == "quick"), (name, run["passes"])
            folder = str(self.folder / f"run {name}")
            glint("replay", capture, "-o", folder, "--set", "cubemap_trace.steps_hq=9")
            glint("view", folder, "--image", "composed", "--no-legend", "-o", str(out))
            assert self.picture("composed", run["run"]) == out.read_bytes(), name

    def test_values_are_those_of_the_files(self):
        out = str(self.folder / "part.exr")
        files = {"composed": ("19-compose.exr", 0), "travelled": ("12-cubemap_trace.exr", 0), "cubemap_index": ("12-cubemap_trace.exr", 1)}
        places = [(0, 0), (20, 25), (63, 35), (33, 7)]
        found = {name: texels(self.written["a"] / file, part, out) for name, (file, part) in files.items()}
        for x, y in places:
            answers = self.post("values", x=x, y=y, size=SIZE, of=[{"run": self.a["run"], "image": name} for name in files])["values"]
            for (name, rows), answer in zip(found.items(), answers):
                column, row = x * len(rows[0]) // SIZE[0], y * len(rows) // SIZE[1]
                assert (answer["x"], answer["y"]) == (column, row), (name, answer)
                assert all(math.isclose(v, e, rel_tol=1e-5) for v, e in zip(answer["values"], rows[row][column], strict=True)), (name, x, y, answer, rows[row][column])

    def test_differences_are_those_of_the_files(self):
        out = str(self.folder / "part.exr")
        rows = [texels(self.written[k] / "19-compose.exr", 0, out) for k in "ab"]
        mean = [[sum(abs(p - q) for p, q in zip(a[:3], b[:3])) / 3 for a, b in zip(*pair)] for pair in zip(*rows)]
        head, drawn = self.raw("composed", what="difference", other=self.b["run"])
        largest = max(map(max, mean))
        assert largest > 0.01 and math.isclose(head["range"][1], largest, rel_tol=1e-5) and math.isclose(head["range"][0], largest / 1000, rel_tol=1e-5), (head["range"], largest)
        pairs = sorted((e, p) for line in zip(mean, drawn) for e, p in zip(*line))
        equal, below = {p for e, p in pairs if e == 0}, {p for e, p in pairs if 0 < e < head["range"][0] * 0.99}
        assert len(equal) == len(below) == 1 and pairs[-1][1] not in equal | below and len({p for _, p in pairs}) > 8, (equal, below)
        # the same differences have the same colour, larger ones go along the same scale
        order = list(dict.fromkeys(p for _, p in pairs))
        assert all(order.index(p) <= order.index(q) for (_, p), (_, q) in zip(pairs, pairs[1:]))
        nothing = self.raw("composed", what="difference", other=self.a["run"])
        assert {p for row in nothing[1] for p in row} == equal, "a run differs from itself"

    def test_a_probe_is_that_of_probe(self):
        for state, options in ((OTHER, ["--set", "cubemap_trace.steps_hq=4"]), ({"preset": "kf2"}, ["--preset", "kf2"])):
            wanted = json.loads(glint("probe", str(self.capture), "20,25", "--json", *options).stdout)
            answer = self.post("probe", state=state, **PIXEL)
            assert close({**wanted, "capture": "street.exr"}, answer["probe"]), state
            text = glint("probe", str(self.capture), "20,25", *options).stdout
            assert text.split("\n", 1)[1] == answer["text"].split("\n", 1)[1] and answer["svg"].startswith("<svg") and answer["no_drawing"] is None
        assert not self.post("probe", state={}, **PIXEL, reference=False)["probe"].get("reference")

    def test_figures_are_those_of_the_commands(self):
        state = {"set": {"pipeline.fog": False}}
        for options, name in ((["replay", "--against", "truth"], "replay"), (["compare", "--presets", "mafia3", "--repeat", "1"], "compare")):
            report = json.loads(glint(options[0], str(self.capture), *options[1:], "--json").stdout)
            found = report["captures"][0]["presets"][0] if name == "compare" else report["runs"][0]["against_truth"]["image"]
            figures = self.post("figures", state=state, effect="reflection", against="truth", metrics=["rmse", "symmetric"])
            for row in found["surfaces"]:
                for metric in ("rmse", "symmetric"):
                    error = next(e for e in figures["errors"] if e["metric"] == metric and e["class"] == row["surfaces"])
                    assert error["pixels"] == row["pixels"] and close(error["value"], row[metric]), (name, row, error)
        assert figures["errors"][0]["set"] == figures["errors"][0]["class"] == "all" and {e["metric"] for e in figures["errors"]} == {"rmse", "symmetric"}
        for member in ("rays", "steps", "fetches", "steps_px", "fetches_px"):
            assert close(figures[member], found[member]), (member, figures[member], found[member])
        ends = [(e["tracer"], e["reason"], e["rays"]) for e in figures["ends"]]
        assert ends == [(e["tracer"], e["reason"], e["rays"]) for e in found["ends"]] and sum(e[2] for e in ends) == figures["rays"], ends
        sums = sum(p["fetches"] or 0 for p in figures["passes"])
        assert math.isclose(sums, figures["fetches"] * figures["rays"], rel_tol=1e-6), (sums, figures["fetches"], figures["rays"])
        assert figures["frame_ns"] is None and self.post("figures", state=state, effect="reflection", rounds=2)["frame_ns"] > 0
        refused(400, "usage", "no slot of the pipeline", self.post, "figures", state={}, effect="bloom")

    def test_the_truth_is_that_of_the_capture(self):
        answer = self.post("answer", state={}, effect="reflection", of="truth")
        found = self.post("values", **PIXEL, size=answer["size"], of=[{"run": answer["run"], "image": answer["picture"]}])["values"][0]["values"]
        out = self.folder / "truth.exr"
        subimages = re.findall(r'^ +name: "([^"]*)"', subprocess.run(["oiiotool", "--info", "-v", "-a", self.capture], check=True, capture_output=True, text=True,
                                                                    env=programs.ENVIRONMENT).stdout, re.M)
        rows = texels(self.capture, next(i for i, n in enumerate(subimages) if n == "truth.reflection.ggx"), str(out))
        assert all(math.isclose(v, e, rel_tol=1e-5) for v, e in zip(found, rows[PIXEL["y"]][PIXEL["x"]])), (found, rows[PIXEL["y"]][PIXEL["x"]])
        assert "fog" in answer["note"] and "reflection" in answer["compares"]

    # ---- What leaves the server ----

    def test_a_preset_replays_to_the_state(self):
        state = {"preset": "mafia3", "set": {"compose.intensity": 0.123456789}, "use": {"blur": "none", "upscale": "bilinear"}}
        answer = self.post("preset", state=state, name="mine")
        # what is the preset's own is left out of a canonical state
        own = {**state, "set": {**state["set"], "cubemap_trace.skip_volume": False}, "use": {**state["use"], "resolve": "hit"}}
        assert self.post("pipeline", state=own)["state"] == {"capture": 0, **state, "skip": [], "force": []}
        file = self.folder / "mine.json"
        file.write_text(answer["preset"], encoding="utf-8")
        assert answer["name"] == json.loads(answer["preset"])["name"] == "mine"
        self.post("write", state=state, name="state")
        glint("replay", str(self.capture), "-o", str(self.folder / "preset"), "--preset", str(file))
        assert same_runs(self.folder / "runs/state", self.folder / "preset")
        for name in ("", ".x", "a/b", "../x", "a b", "x" * 101, "ä", None):
            refused(400, "usage", "name: expected", self.post, "preset", state={}, name=name)

    def test_a_report_is_a_page(self):
        page = self.post("report", a={}, b=OTHER)
        glint("report", str(self.written["a"]), str(self.written["b"]), "-o", str(self.folder / "report.html"))
        title = lambda text: re.search(rb"<title>(.*?)</title>", text)[1]
        wanted = (self.folder / "report.html").read_bytes()
        assert page.startswith(b"<!doctype html>") and b"steps_hq" in page and page.rstrip().endswith(b"</html>") == wanted.rstrip().endswith(b"</html>")
        assert abs(len(page) - len(wanted)) < len(wanted) / 20 and title(page), (len(page), len(wanted))

    def test_runs_are_written_under_plain_new_names_alone(self):
        before = sorted(p.name for p in self.folder.iterdir())
        for name in ("", ".", "..", ".hidden", "a/b", "/tmp/x", "../x", "..\\x", "a b", "x\n", "x" * 101, "ä", "$(x)", "-o;", "a:b"):
            refused(400, "usage", "name: expected", self.post, "write", state={}, name=name)
        (self.folder / "runs/link").symlink_to(self.folder / "elsewhere")
        (self.folder / "runs/file").write_text("kept")
        for name in ("a", "link", "file"):
            refused(400, "usage", "exists", self.post, "write", state={}, name=name)
        assert sorted(p.name for p in self.folder.iterdir()) == before and (self.folder / "runs/file").read_text() == "kept"
        with Live(GLINT, self.capture) as other:
            assert other.get("registry")["out"] is False
            refused(400, "usage", "-o", other.post, "write", state={}, name="x")

    # ---- Several at once ----

    def test_an_urgent_request_gives_up_the_others(self):
        given_up, started = [], threading.Barrier(4)

        def ask(request, **members):
            started.wait()
            try:
                self.post(request, **members)
                given_up.append("answered")
            except Refused as refusal:
                given_up.append((refusal.status, refusal.code))

        others = [threading.Thread(target=ask, args=("run",), kwargs={"state": LONG}), threading.Thread(target=ask, args=("run",), kwargs={"state": {**LONG, "preset": "kf2"}}),
                  threading.Thread(target=ask, args=("figures",), kwargs={"state": LONG, "effect": "reflection", "rounds": 100})]
        for thread in others:
            thread.start()
        started.wait()
        time.sleep(1)
        state = {"set": {"cubemap_trace.steps_hq": 6}}
        start = time.monotonic()
        run = self.post("run", state=state, urgent=True)
        for thread in others:
            thread.join()
        assert given_up == 3 * [(409, "superseded")] and run["state"]["set"] == state["set"], (given_up, time.monotonic() - start)
        self.post("write", state=state, name="after")
        glint("replay", str(self.capture), "-o", str(self.folder / "after"), "--set", "cubemap_trace.steps_hq=6")
        assert same_runs(self.folder / "runs/after", self.folder / "after")

    def test_two_clients_get_their_own_answers(self):
        pictures = {steps: self.picture("composed", self.post("run", state={"set": {"cubemap_trace.steps_hq": steps}})["run"]) for steps in (1, 64)}
        assert pictures[1] != pictures[64]
        wrong = []

        def client(steps):
            for _ in range(6):
                run = self.post("run", state={"set": {"cubemap_trace.steps_hq": steps}}, client=str(steps))
                if run["state"]["set"] != {"cubemap_trace.steps_hq": steps} or self.picture("composed", run["run"]) != pictures[steps]:
                    wrong.append(steps)

        clients = [threading.Thread(target=client, args=(steps,)) for steps in (1, 64)]
        for thread in clients:
            thread.start()
        for thread in clients:
            thread.join()
        assert not wrong, wrong

    def test_the_example_finds_what_the_figures_say(self):
        said = subprocess.run([sys.executable, TUNE, self.live.address], capture_output=True, text=True, timeout=100)
        errors = {int(n): float(e) for n, e in re.findall(r"(\d+) cells: error ([\d.]+)", said.stdout)}
        enough = re.search(r"enough: (\d+)\n", said.stdout)
        assert said.returncode == 0 and len(errors) == 6 and enough and int(enough[1]) in errors, said
        assert errors[int(enough[1])] <= 1.0101 * min(errors.values()) + 1e-4, said.stdout

    # ---- Begin and end ----

    def test_ending_leaves_no_folder(self):
        for number, busy in ((signal.SIGINT, False), (signal.SIGTERM, True), (signal.SIGHUP, False)):
            folders = Folders(self.folder)
            server = Live(GLINT, self.capture, env=folders.environment())
            server.post("run", state={}, draft=True)  # which lies in the private folder
            assert len(folders.left()) == 1, folders.left()
            said = []

            def ask():
                try:
                    said.append(server.post("run", state=LONG))
                except (Refused, OSError, http.client.HTTPException) as error:
                    said.append(error)

            asking = threading.Thread(target=ask)
            if busy:
                asking.start()
                time.sleep(0.7)
                assert not said, said
            start = time.monotonic()
            server.process.send_signal(number)
            status = server.end()
            if busy:
                asking.join()
                assert isinstance(said[0], (Refused, OSError, http.client.HTTPException)), said
            assert status == 0 and not folders.left() and time.monotonic() - start < 20, (number, status, folders.left())

    def test_a_token_file(self):
        file, token = self.folder / "token", "a-token-of-my-own"
        for text, mode, words in ((token, 0o644, "others may read it"), ("short", 0o600, "16 characters"), ("", 0o600, "16 characters"), (257 * "a", 0o600, "16 to 256 characters"), (None, 0, "No such file")):
            file.unlink(missing_ok=True)
            if text is not None:
                file.write_text(text + "\n")
                file.chmod(mode)
            done = subprocess.run([GLINT, "live", self.capture, "--token-file", file], capture_output=True, text=True, timeout=60)
            assert done.returncode in (1, 2) and words in " ".join(done.stderr.split()) and not done.stdout, (mode, done)
        file.write_text(token + "\nsecond line\n")
        file.chmod(0o600)
        process = subprocess.Popen([GLINT, "live", self.capture, "--token-file", file], stdout=subprocess.PIPE, text=True)
        address = process.stdout.readline().strip()
        try:
            assert token not in address and "#" not in address, address
            for given, status in ((token, 200), ("a-token-of-my-owm", 401), ("", 401), (token + "\nsecond line", 0)):
                connection = http.client.HTTPConnection(address.removeprefix("http://").rstrip("/"), timeout=60)
                try:
                    connection.request("GET", "/api/v1/registry", headers={"Authorization": f"Bearer {given}"})
                    assert connection.getresponse().status == status, (given, status)
                except ValueError:
                    assert status == 0, given
                connection.close()
        finally:
            process.terminate()
            assert process.wait(60) == 0
            process.stdout.close()
        done = subprocess.run([GLINT, "live", self.capture, "--listen", "0.0.0.0"], capture_output=True, text=True, timeout=60)
        assert done.returncode == 2 and "--token-file" in done.stderr, done


def main():
    with tempfile.TemporaryDirectory(prefix="glint-live-api-") as folder:
        tests = Tests(pathlib.Path(folder))
        try:
            return tap.run(tests)
        finally:
            tests.live.end()


sys.exit(main())
