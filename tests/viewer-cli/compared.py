"""Comparisons across kinds: a run with a part of a capture, other sizes, metrics in the table, images of errors, the knee of a sweep:
compared.py GLINT. Speaks TAP."""
import json
import math
import os
import re
import subprocess
import sys
import tempfile

import tap

GLINT = sys.argv[1]


def run(words):
    return subprocess.run([GLINT, *words.split()], capture_output=True, text=True)


def ok(words, status=0):
    done = run(words)
    assert done.returncode == status, (words, done.returncode, done.stdout[-1000:], done.stderr)
    return done.stdout


def dumped(path):
    """All that oiiotool prints of a file: {part: (channels, a tuple for each texel, row by row)}. It takes longer to start than to read."""
    command = ["oiiotool", "-a", "-v", "--dumpdata", path]
    out = subprocess.run(command, capture_output=True, text=True, check=True, env=tap.programs.ENVIRONMENT).stdout
    parts, channels, rows, name = {}, [], [], path
    for line in out.splitlines():
        if listed := re.match(r" +channel list: (.*)", line):
            channels, rows = [channel.split()[0] for channel in listed[1].split(", ")], []
        elif named := re.match(r" +(?:oiio:subimagename|name): \"(.*)\"", line):
            name = named[1]
        elif texel := re.match(r" +Pixel [^:]*: ([-+0-9. einfa]+)", line):
            rows.append(tuple(map(float, texel[1].split())))
            parts[name] = channels, rows
    return parts


def texels(path, part, count):
    """The values of a part: a list of tuples, row by row, of its first `count` channels in oiiotool's order."""
    return [row[:count] for row in dumped(path)[part][1]]


def image(folder, name):
    """The file and part of a run's image."""
    with open(f"{folder}/run.json", encoding="utf-8") as file:
        record = json.load(file)
    for owner in record["passes"] + [record.get("compared", {"images": []})]:
        for found in owner["images"]:
            if found["name"] == name:
                return f"{folder}/{found['file']}", found["part"]
    raise AssertionError(name)


def knee(x, y):
    """The index of the last knee by Kneedle (Satopaa et al., 2011, S = 1) over log x, of the closest curve that never rises; None: there is none."""
    pools = []
    for value in y if y[0] > y[-1] else []:
        pools.append([value, 1])
        while len(pools) > 1 and pools[-2][0] < pools[-1][0]:
            (a, n), (b, m) = pools.pop(-2), pools.pop(-1)
            pools.append([(a * n + b * m) / (n + m), n + m])
    fit = [value for value, n in pools for _ in range(n)]
    if not fit or fit[0] <= fit[-1]:
        return None
    x = [math.log(v) for v in x]
    above = [(fit[0] - b) / (fit[0] - fit[-1]) - (a - x[0]) / (x[-1] - x[0]) for a, b in zip(x, fit)]
    found = None
    for i in range(1, len(above) - 1):
        until = next((k for k in range(i + 1, len(above)) if above[k] >= above[i]), len(above))
        if above[i] > 0 and above[i - 1] <= above[i] > above[i + 1] and min(above[i + 1:until]) < above[i] - 1 / (len(x) - 1):
            found = i
    return found


def close(a, b, relative=1e-4):
    return math.isclose(a, b, rel_tol=relative, abs_tol=1e-6)


class Tests:
    def __init__(self, folder):
        os.chdir(folder)
        ok("sample room --light 4 --size 48x27 --cube-size 8 --truth 4 -o s.exr")
        ok("reference s.exr -o ref --rays 16")
        ok(f"replay s.exr -p {tap.PLAIN} -o run")
        ok(f"replay s.exr -p {tap.PLAIN} -o other --set screen_trace.steps=8")

    def test_the_true_picture_is_made_of_the_other_truths(self):
        """That of `scene`, which has the captured indirect light, with the traced light in its place."""
        ok("sample room --light 4 --size 32x18 --cube-size 8 --truth 4 --finished 4 --truth-of indirect,picture -o p.exr")

        parts = dumped("p.exr")

        def part(name, *chosen):
            channels, rows = parts[name]
            at = [channels.index(channel) for channel in chosen]
            return [tuple(row[i] for i in at) for row in rows]

        colors = [part(name, "R", "G", "B") for name in ("truth.picture", "scene", "indirect", "truth.indirect")]
        surfaces = [part("gbuffer", name) for name in ("albedo.R", "albedo.G", "albedo.B", "material.metalness", "depth.Z")]
        changed = 0
        for picture, scene, indirect, traced, *albedo, (metalness,), (depth,) in zip(*colors, *surfaces):
            for k in range(3) if math.isfinite(depth) else ():
                right = scene[k] + (1 - metalness) * albedo[k][0] * traced[k] - indirect[k]
                # albedo has 8 bits, the pictures are halves
                assert abs(picture[k] - right) <= 1e-3 * (abs(scene[k]) + abs(indirect[k])) + traced[k] / 255 + 1e-4, (picture, right)
                changed += abs(right - scene[k]) > 0.01
        assert changed > 100, changed

    def test_a_run_is_compared_with_a_part_of_the_capture(self):
        found = json.loads(ok("diff run:reflection s.exr:truth.reflection.ggx --metrics=rmse,symmetric --json", 2))
        pair = found["images"][0]
        ours, theirs = texels(*image("run", "reflection"), 3), texels("s.exr", "truth.reflection.ggx", 3)
        squares = [(a - b) ** 2 for x, y in zip(ours, theirs) for a, b in zip(x, y)]
        assert len(ours) == len(theirs) == 48 * 27
        assert close(pair["rms"], math.sqrt(sum(squares) / len(squares))), pair["rms"]
        assert close(pair["metrics"]["surfaces"][0]["rmse"], pair["rms"])
        absolute = [abs(a - b) / (abs(a) + abs(b) + 0.05) for x, y in zip(ours, theirs) for a, b in zip(x, y)]
        assert close(pair["metrics"]["surfaces"][0]["symmetric"], sum(absolute) / len(absolute))
        assert ok("diff s.exr:truth.reflection.ggx run:reflection", 2).count("reflection") >= 1
        ok("diff run:reflection s.exr:truth.reflection.ggx --html page.html -o heat.png --side-by-side both.png", 2)
        assert all(os.path.getsize(name) > 1000 for name in ("page.html", "heat.png", "both.png"))

    def test_values_of_a_capture_are_decoded(self):
        for name, more in (("box", ""), ("encoded", "--depth reversed_infinite")):
            ok(f"sample mirror_box --size 48x27 --cube-size 8 {more} -o {name}.exr")
        ok(f"replay box.exr -p {tap.PLAIN} -o boxed --passes downsample")
        found = json.loads(ok("diff boxed:depth_half encoded.exr:gbuffer:depth --resample --json", 2))
        assert found["images"][0]["largest"]["channel"] == "Z" and found["images"][0]["width"] == 24, found
        assert found["images"][0]["rms"] < 2, found["images"][0]["rms"]  # metres, not a depth buffer's 0 to 1

    def test_what_cannot_be_compared_says_what_can(self):
        assert "did you mean truth.reflection.ggx?" in run("diff run:reflection s.exr:truth.reflection.gg").stderr
        assert "expected one image to compare" in run("diff run s.exr:truth.reflection.ggx").stderr
        assert "no channel in common" in ok("diff run:reflection s.exr:gbuffer:depth", 2)
        assert "s.exr:PART" in run("diff run s.exr").stderr

    def test_fog_that_one_side_lacks_is_said(self):
        ok("set s.exr fogColor=1,1,1 fogDensity=0.1 -o fog.exr")
        assert "the truth has no fog, the run has" in ok("diff run:reflection fog.exr:truth.reflection.ggx", 2)
        assert "fog" not in ok("diff run:reflection s.exr:truth.reflection.ggx", 2)

    def test_a_reference_is_compared(self):
        pair = json.loads(ok("diff run:reflection ref:reflection --json", 2))["images"][0]
        ours, theirs = texels(*image("run", "reflection"), 3), texels(*image("ref", "reflection"), 3)
        squares = [(a - b) ** 2 for x, y in zip(ours, theirs) for a, b in zip(x, y)]
        assert close(pair["rgb"]["rms"], math.sqrt(sum(squares) / len(squares))), pair["rgb"]

    def test_other_sizes_are_compared_where_that_is_asked_for(self):
        plain = ok("diff run:reflection_half run:reflection", 3)
        assert "24 x 14 and 48 x 27; --resample compares them" in plain, plain
        done = ok("diff run:reflection_half run:reflection --resample", 2)
        assert "24 x 14 and 48 x 27, compared at 24 x 14" in done, done
        assert "24 x 14 and 48 x 27" in ok("diff run:reflection_half run:reflection --resample --json -o heat.png", 2)

    def test_a_texel_is_the_mean_of_the_area_that_it_covers(self):
        make = ["oiiotool", "--create", "7x5", "3", "--noise:type=uniform:min=-1:max=9:seed=3", "-d", "float", "-o", "large.exr"]
        subprocess.run(make, check=True)
        subprocess.run(["oiiotool", "--create", "3x2", "3", "-d", "float", "-o", "black.exr"], check=True)
        large, width, height = texels("large.exr", "large.exr", 3), 7, 5
        squares = []
        for y in range(2):
            for x in range(3):
                for k in range(3):
                    total = 0.0
                    for v in range(height):
                        for u in range(width):
                            across = max(0.0, min(u + 1, (x + 1) * width / 3) - max(u, x * width / 3))
                            down = max(0.0, min(v + 1, (y + 1) * height / 2) - max(v, y * height / 2))
                            total += across * down * large[v * width + u][k]
                    squares.append((total / (width / 3 * height / 2)) ** 2)
        pair = json.loads(ok("diff large.exr black.exr --resample --json", 2))["images"][0]
        assert (pair["width"], pair["height"]) == (3, 2) and close(pair["rms"], math.sqrt(sum(squares) / len(squares))), pair

    def test_metrics_of_runs_are_in_the_table(self):
        table = ok("diff run other --metrics", 2)
        assert re.search(r"image +channels +.*RMSE.*relative MSE.*symmetric.*LIP", table), table
        line = next(row for row in table.splitlines() if re.match(r"reflection +R G B ", row))
        pair = next(p for p in json.loads(ok("diff run other --metrics --json", 2))["images"] if p["name"] == "reflection")
        shown = [float(word) for word in line.split()[4:]]
        metrics = pair["rgb"]["metrics"]["surfaces"][0]
        assert any(math.isclose(value, metrics["rmse"], rel_tol=1e-3) for value in shown), (shown, metrics)
        assert any(math.isclose(value, metrics["flip"], rel_tol=1e-3) for value in shown), (shown, metrics)
        assert close(metrics["rmse"], pair["rgb"]["rms"])
        one = ok("diff run other --metrics rmse", 2)
        assert "LIP" not in one and "RMSE" in one, one

    def test_the_images_of_the_error_are_in_the_run(self):
        figures = json.loads(ok(f"replay s.exr -p {tap.PLAIN} -o judged --against both=ref --json"))["runs"][0]["against_truth"]["image"]["surfaces"][0]
        error, flip = texels(*image("judged", "error"), 1), texels(*image("judged", "flip"), 1)
        ours, theirs = texels(*image("judged", "reflection"), 3), texels("s.exr", "truth.reflection.ggx", 3)
        lit = [i for i, (value,) in enumerate(error) if value > 0]
        assert figures["pixels"] >= len(lit) > 200
        for i in lit:
            assert close(error[i][0], sum(abs(a - b) for a, b in zip(ours[i], theirs[i])) / 3, 1e-3), i
        assert 0 < max(v for (v,) in flip) <= 1 and 0 < figures["flip"] <= 1
        ok("view judged:error -o error.png")
        ok("view judged:flip -o flip.png")
        ok("report judged -o judged.html")
        listed = ok("info judged")
        assert "error" in listed and "flip" in listed
        with open("judged/run.json", encoding="utf-8") as file:
            names = [found["name"] for found in json.load(file)["compared"]["images"]]
        assert names == ["error", "flip", "reference_error", "reference_flip"], names
        assert ok("view judged -o default.png") == ok("view run -o plain.png")
        same = json.loads(ok("diff judged judged --json --verbose"))
        assert {"error", "flip"} <= {pair["name"] for pair in same["images"]}
        ok(f"replay s.exr -p {tap.PLAIN} -o judged --passes downsample")
        assert not os.path.exists("judged/errors.exr") and "flip" not in ok("info judged")

    def test_a_sweep_of_one_parameter_has_its_knee(self):
        out = ok(f"sweep s.exr -p {tap.PLAIN} -o swept --reference truth --repeat 0 --no-pictures --vary screen_trace.steps=1,2,4,8,16,32,64,128")
        points = json.load(open("swept/points.json", encoding="utf-8"))
        for name in ("parameter-error.svg", "parameter-fetches.svg"):
            with open(f"swept/{name}", encoding="utf-8") as file:
                text = file.read()
            assert "screen_trace.steps" in text and ("knee" in text) == (points["knee"] is not None), name
        assert not os.path.exists("swept/parameter-time.svg")
        with open("swept/index.html", encoding="utf-8") as file:
            assert "By screen_trace.steps" in file.read()
        curve = sorted((float(p["values"]["screen_trace.steps"]), p["error"]["mean"], p["point"]) for p in points["points"])
        expected = knee([x for x, _, _ in curve], [y for _, y, _ in curve])
        assert points["knee"] == (None if expected is None else curve[expected][2]), (points["knee"], curve)
        assert ("knee: screen_trace.steps=" in out) == (expected is not None), out


with tempfile.TemporaryDirectory() as folder:
    failed = tap.run(Tests(folder))
    os.chdir("/")
sys.exit(failed)
