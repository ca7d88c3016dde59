"""glint view beyond a PNG: statistics, terminals, tev, cube maps by longitude and latitude, MIP levels: view.py GLINT. Speaks TAP."""
import json
import math
import os
import re
import socket
import struct
import subprocess
import sys
import tempfile
import threading

import tap
from pictures import read_png

GLINT = sys.argv[1]


def call(*words, **more):
    more = {"env": tap.programs.ENVIRONMENT, **more} if words[0] == "oiiotool" else more
    run = subprocess.run(words, capture_output=True, **more)
    assert run.returncode == 0, (words, run.stdout[-2000:], run.stderr)
    return run.stdout


def dump(path):
    """All texels of a picture, row by row, as texts."""
    return [row.split() for row in re.findall(r"Pixel[^:]*: ([-0-9. e]+)", call("oiiotool", "--dumpdata", path, text=True))]


class Png:
    def __init__(self, path):
        rows = read_png(path)
        self.width, self.height = len(rows[0]), len(rows)
        self.texels = [texel for row in rows for texel in row]

    def __call__(self, x, y):
        return self.texels[y * self.width + x]


class Tests:
    def __init__(self, folder):
        self.folder = folder

    def path(self, name):
        return os.path.join(self.folder, name)

    def make(self, name, *words):
        call("oiiotool", *words, "-d", "float", "-o", self.path(name))
        return self.path(name)

    def test_statistics_are_those_of_oiiotool(self):
        path = self.make("noise.exr", "--create", "64x48", "3", "--noise:type=gaussian:mean=2:stddev=0.5:seed=7")
        text = call("oiiotool", path, "--printstats", text=True)
        expected = {name: [float(v) for v in re.search(rf"{name}: *([-0-9. e]+)", text).group(1).split()] for name in ("Min", "Max", "Avg", "StdDev")}
        found = json.loads(call(GLINT, "view", path, "--stats", "--json"))
        assert [c["channel"] for c in found["channels"]] == ["R", "G", "B"]
        for k, c in enumerate(found["channels"]):
            for ours, theirs in (("min", "Min"), ("max", "Max"), ("mean", "Avg"), ("deviation", "StdDev")):
                assert math.isclose(c[ours], expected[theirs][k], rel_tol=1e-5, abs_tol=2e-6), (ours, c[ours], expected[theirs][k])
            assert c["finite"] == 64 * 48 and c["nan"] == c["infinite"] == 0
            assert c["min"] < c["p1"] < c["median"] < c["p99"] < c["max"]
            assert abs(c["median"] - 2) < 0.05  # of 3,072 random numbers: five standard errors

    def test_histogram_counts_every_finite_value_once(self):
        path = self.make("ramp.exr", "--pattern", "fill:left=0:right=1", "256x2", "1")
        whole = json.loads(call(GLINT, "view", path, "--histogram", "--bins", "8", "--json"))["channels"][0]["histogram"]
        assert whole["counts"] == [64] * 8 and whole["below"] == whole["above"] == 0, whole
        part = json.loads(call(GLINT, "view", path, "--histogram", "--bins", "4", "--range", "0.25,0.5", "--json"))["channels"][0]["histogram"]
        assert part["below"] + part["above"] + sum(part["counts"]) == 512 and 0 < part["below"] < part["above"], part
        text = call(GLINT, "view", path, "--histogram", "--bins", "2", text=True)
        assert text.count("█") == 80 and "50.00" in text, text

    def test_blocks_have_the_colours_of_the_picture(self):
        path = self.make("two.exr", "--create", "40x20", "3", "--fill:color=1,0,0", "20x20+0+0", "--fill:color=0,0,1", "20x20+20+0")
        text = call(GLINT, "view", path, "--view", "sRGB", "--terminal=blocks", text=True)
        colours = set(re.findall(r"[34]8;2;(\d+);(\d+);(\d+)", text))
        assert {("255", "0", "0"), ("0", "0", "255")} <= colours and all(green == "0" for _, green, _ in colours), colours

    def test_a_terminal_that_has_sixels_or_kitty_gets_them(self):
        path = self.make("small.exr", "--create", "8x8", "3", "--fill:color=0,1,0", "8x8")
        assert b"\x1b_G" in call(GLINT, "view", path, "--terminal", env=dict(os.environ, TERM="xterm-kitty"))
        assert b"\x1b_G" not in call(GLINT, "view", path, "--terminal", env=dict(os.environ, TERM="xterm-256color"))
        assert b"\x1b_G" in call(GLINT, "view", path, "--terminal=kitty")
        assert b"\x1bP" in call(GLINT, "view", path, "--terminal=sixel")

    def test_without_a_terminal_it_asks_where_to(self):
        path = self.make("none.exr", "--create", "8x8", "3")
        run = subprocess.run([GLINT, "view", path], capture_output=True, text=True)
        assert run.returncode == 2 and "-o FILE.png" in run.stderr, run.stderr

    def test_tev_receives_every_value(self):
        path = self.make("sent.exr", "--create", "31x17", "3", "--noise:type=uniform:min=-1:max=9:seed=3")
        server = socket.create_server(("127.0.0.1", 0))
        received = bytearray()

        def listen():
            connection, _ = server.accept()
            while block := connection.recv(65536):
                received.extend(block)

        listener = threading.Thread(target=listen)
        listener.start()
        call(GLINT, "view", path, "--to-tev", f"127.0.0.1:{server.getsockname()[1]}")
        listener.join(10)
        messages = []
        while received:
            (length,) = struct.unpack_from("<I", received)
            messages.append(bytes(received[4:length]))
            del received[:length]
        create, update = messages
        name, rest = create[2:].split(b"\0", 1)
        assert create[:2] == b"\x04\x01" and rest == struct.pack("<iii", 31, 17, 3) + b"R\0G\0B\0", create
        assert update[:2] == b"\x06\x01" and update[2:].startswith(name + b"\0" + struct.pack("<i", 3) + b"R\0G\0B\0"), update[:40]
        tail = struct.pack("<iiii", 0, 0, 31, 17) + struct.pack("<qqq", 0, 1, 2) + struct.pack("<qqq", 3, 3, 3)
        at = len(name) + 3 + 4 + 6
        assert update[at : at + len(tail)] == tail
        values = struct.unpack("<%df" % (31 * 17 * 3), update[at + len(tail) :])
        expected = [float(v) for row in dump(path) for v in row]
        assert len(expected) == len(values)
        assert all(math.isclose(a, b, rel_tol=1e-5, abs_tol=1e-6) for a, b in zip(values, expected))

    def test_no_tev_is_an_error_that_says_so(self):
        path = self.make("unsent.exr", "--create", "4x4", "3")
        with socket.create_server(("127.0.0.1", 0)) as server:
            port = server.getsockname()[1]
        run = subprocess.run([GLINT, "view", path, "--to-tev", f"127.0.0.1:{port}"], capture_output=True, text=True)
        assert run.returncode == 1 and "tev" in run.stderr and str(port) in run.stderr, run.stderr

    def test_longitude_and_latitude_put_plus_z_in_the_middle(self):
        colours = ["1,0,0", "0,1,1", "0,1,0", "1,0,1", "0,0,1", "1,1,0"]  # +X -X +Y -Y +Z -Z
        fills = [w for i, c in enumerate(colours) for w in (f"--fill:color={c}", f"8x8+0+{8 * i}")]
        path = self.make("cube.exr", "--create", "8x48", "3", *fills)
        png = self.path("latlong.png")
        call(GLINT, "view", path, "--latlong", "--view", "sRGB", "-o", png)
        found = Png(png)
        for (x, y), expected in {(16, 8): (0, 0, 255), (24, 8): (255, 0, 0), (8, 8): (0, 255, 255), (0, 8): (255, 255, 0), (31, 8): (255, 255, 0), (16, 0): (0, 255, 0), (3, 15): (255, 0, 255)}.items():
            assert found(x, y) == expected, ((x, y), found(x, y), expected)

    def test_levels_stand_beside_each_other_by_one_range(self):
        capture, run = self.path("levels.exr"), self.path("run")
        call(GLINT, "sample", "mirror_box", "-o", capture, "--size", "64x36", "--cube-size", "16")
        call(GLINT, "replay", capture, "-o", run, "--all", "--outputs", "lit_mips")
        png, one = self.path("levels.png"), self.path("one.png")
        call(GLINT, "view", f"{run}:lit_mips", "--levels", "--view", "sRGB", "-o", png)
        call(GLINT, "view", f"{run}:lit_mips.level1", "--view", "sRGB", "-o", one)
        chain, level = Png(png), Png(one)
        assert (chain.width, chain.height) == (96, 36) and (level.width, level.height) == (32, 18)
        assert all(chain(64 + x, y) == level(x, y) for x in range(32) for y in range(18))

    def test_a_run_s_picture_equals_oiiotool_s(self):
        """The same file, configuration and view through another program, which may round differently; and a configuration made for this test,
        whose view is a single conversion between two spaces."""
        capture, run, config = self.path("colour.exr"), self.path("colour"), self.path("own.ocio")
        call(GLINT, "sample", "room", "--light=4", "-o", capture, "--size", "96x54", "--cube-size", "16")
        call(GLINT, "replay", capture, "-p", "kf2", "-o", run, "--outputs", "composed")
        (exr,) = [os.path.join(run, name) for name in os.listdir(run) if name.endswith("-compose.exr")]
        with open(config, "w", encoding="utf-8") as file:
            file.write("""ocio_profile_version: 2
roles: {default: linear, scene_linear: linear}
file_rules:
  - !<Rule> {name: Default, colorspace: default}
displays:
  television:
    - !<View> {name: warm, colorspace: shown}
colorspaces:
  - !<ColorSpace> {name: linear}
  - !<ColorSpace>
    name: shown
    from_scene_reference: !<GroupTransform>
      children:
        - !<MatrixTransform> {matrix: [1.1, 0.05, 0, 0, 0.02, 0.9, 0.03, 0, 0, 0.1, 0.7, 0, 0, 0, 0, 1]}
        - !<ExponentWithLinearTransform> {gamma: [2.2, 2.2, 2.2, 1], offset: [0.04, 0.04, 0.04, 0], direction: inverse}
""")
        builtin = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../viewer-cli/draw/glint.ocio")
        for words, theirs in ((["--view", "ACES"], ["--colorconfig", builtin, exr, "--ociodisplay:from=lin_rec709", "sRGB", "ACES"]),
                              (["--ocio", builtin, "--view", "sRGB"], ["--colorconfig", builtin, exr, "--ociodisplay:from=lin_rec709", "sRGB", "sRGB"]),
                              (["--ocio", config, "--display", "television", "--view", "warm"], ["--colorconfig", config, exr, "--colorconvert", "linear", "shown"])):
            a, b = self.path("ours.png"), self.path("theirs.png")
            call(GLINT, "view", exr, *words, "-o", a)
            call("oiiotool", *theirs, "-d", "uint8", "-o", b)
            ours, other = Png(a).texels, Png(b).texels
            assert len(ours) == len(other) == 96 * 54 and len(set(ours)) > 1000
            assert max(abs(x - y) for p, q in zip(ours, other) for x, y in zip(p, q)) <= 1, words

    def test_a_configuration_of_a_newer_version_is_told_what_works(self):
        """The versions that the message names do work, and the next one does not."""
        exr, png = self.make("any.exr", "--pattern", "constant:color=0.5,0.5,0.5", "8x8", "3"), self.path("any.png")

        def view(version):
            with open(self.path("version.ocio"), "w", encoding="utf-8") as file:
                file.write(f"ocio_profile_version: {version}\nroles: {{default: a, scene_linear: a}}\n" + (
                    "file_rules:\n  - !<Rule> {name: Default, colorspace: default}\n" if version[0] != "1" else "") +
                    "displays:\n  d:\n    - !<View> {name: v, colorspace: a}\ncolorspaces:\n  - !<ColorSpace> {name: a}\n")
            return subprocess.run([GLINT, "view", exr, "--ocio", self.path("version.ocio"), "-o", png], capture_output=True, text=True)
        newer = view("9.7")
        found = re.search(r"version.ocio: a configuration of version 9.7; this is OpenColorIO [\d.]+, which reads versions 1.0 and 2.0(?: to 2\.(\d+))?\.",
                          newer.stderr)
        assert newer.returncode == 1 and found, newer.stderr
        newest = int(found[1] or 0)
        for version in ("1", "2", f"2.{newest}"):
            done = view(version)
            assert done.returncode == 0, (version, done.stderr)
        assert f"a configuration of version 2.{newest + 1}; " in view(f"2.{newest + 1}").stderr
        if newest < 2:
            done = subprocess.run([GLINT, "view", exr, "--ocio", "ocio://default", "-o", png], capture_output=True, text=True)
            assert done.returncode == 1 and "ocio://default: built-in configurations need OpenColorIO 2.2 or newer" in done.stderr, done.stderr

    def test_percentiles_choose_the_range(self):
        path = self.make("wide.exr", "--pattern", "fill:left=0:right=100", "256x1", "1")
        png = self.path("half.png")
        call(GLINT, "view", path, "--as", "distance", "--percentiles", "25,75", "--no-legend", "-o", png)
        found = Png(png)
        assert found(0, 0) == found(60, 0) != found(128, 0) and found(200, 0) == found(255, 0) != found(128, 0)

    def test_weights_are_shown_from_0_to_1_and_steps_from_0(self):
        path = self.make("weight.exr", "--pattern", "constant:color=0.5", "4x4", "1")
        named, ranged = self.path("named.png"), self.path("ranged.png")
        for kind, ends in (("weight", "0,1"), ("steps", "0,0.5")):
            call(GLINT, "view", path, "--as", kind, "--no-legend", "-o", named)
            call(GLINT, "view", path, "--as", "distance", "--range", ends, "--no-legend", "-o", ranged)
            assert Png(named).texels == Png(ranged).texels

    def test_invalid_shows_what_is_no_number(self):
        path = self.make("bad.exr", "--create", "2x1", "3", "--addc", "nan,0,0", "--create", "2x1", "3", "--addc", "0,inf,0", "--create", "2x1", "3", "--mosaic", "3x1")
        found = {c["channel"]: (c["nan"], c["infinite"], c["finite"]) for c in json.loads(call(GLINT, "view", path, "--stats", "--json"))["channels"]}
        assert found == {"R": (2, 0, 4), "G": (0, 2, 4), "B": (0, 0, 6)}, found
        png = self.path("bad.png")
        call(GLINT, "view", path, "--as", "invalid", "--no-legend", "-o", png)
        shown = Png(png)
        assert [shown(x, 0) for x in (0, 2)] == [(255, 0, 255), (0, 255, 255)] and len(set(shown(4, 0))) == 1


with tempfile.TemporaryDirectory() as place:
    sys.exit(tap.run(Tests(place)))
