"""What is changed, and the commands that read it. Each kind has a folder of its own, in which all commands run."""
import base64
import json
import os
import shutil
import struct
import zlib

import tap
from mutate import TEXTS, mutate_file, mutate_json, read, write


class Kind:
    """`commands` are (words, statuses) with paths relative to the folder."""
    name, commands, timeout_s = "", [], 20
    slow = False  # replays, in seconds
    device = False  # opens a device
    unchanged = (0,)  # exit statuses where nothing is changed
    named = None  # what a message may name instead of a file
    environment = {}
    given = ()  # files whose names are arguments: a pipe of the user's may wait, and a link of the user's is followed
    statuses = (0, 1, 2)

    def make(self, folder):
        raise NotImplementedError

    def targets(self, folder):
        """The files that are changed."""
        raise NotImplementedError

    def after(self, folder):
        """A command that has to succeed afterwards, or None."""

    def mutate(self, folder, rng, secret):
        """Changes one to three files; returns what was done, and environment variables."""
        done = []
        targets = self.targets(folder)
        for _ in range(rng.choice([1, 1, 1, 2])):
            path = rng.choice(targets)
            if os.path.isfile(path) and not os.path.islink(path):
                name = os.path.relpath(path, folder)
                done.append(f"{name}: {mutate_file(path, rng, secret, name in self.given)}")
        return done, self.environment


def below(folder, *suffixes):
    return sorted(os.path.join(root, name) for root, _, names in os.walk(folder) for name in names if name.endswith(suffixes))


def small_capture(folder, name="tiny.exr"):
    tap.glint("sample", "street", "--light=1", "-o", os.path.join(folder, name), "--size", "16x9", "--cube-size", "8")


def small_run(folder):
    small_capture(folder)
    tap.glint("replay", "tiny.exr", "-p", tap.PLAIN, "-o", "run", folder=folder)
    shutil.copytree(os.path.join(folder, "run"), os.path.join(folder, "good"))


class Run(Kind):
    name = "run"
    commands = [("info run", None), ("info run --json", None), ("view run -o out.png", None), ("view run --sheet -o out.png", None), ("report run -o out.html", None),
                ("export run -o out.exr", None), ("diff good run", (0, 1, 2, 3, 4)), ("check run --baseline good", (0, 1, 2, 3, 4)),
                ("check run --baseline new --approve", (0, 1, 2, 3, 4)), ("check run --baseline good --approve", (0, 1, 2, 3, 4)), ("--complete glint view run --image=", None)]

    def make(self, folder):
        small_run(folder)

    def targets(self, folder):
        records = [os.path.join(folder, "run", "run.json")]
        return records * 6 + below(os.path.join(folder, "run"), ".exr")


class Baseline(Run):
    name = "baseline"
    commands = [("check good --baseline run", (0, 1, 2, 3, 4)), ("check good --baseline run --json", (0, 1, 2, 3, 4)), ("check good --baseline run --approve", (0, 1, 2, 3, 4)),
                ("check goods --baseline runs --html out.html", (0, 1, 2, 3, 4)), ("check goods --baseline runs --approve", (0, 1, 2, 3, 4)), ("diff run good --html out.html", (0, 1, 2, 3, 4))]

    def make(self, folder):
        small_run(folder)
        for name, of in (("runs", "run"), ("goods", "good")):
            shutil.copytree(os.path.join(folder, of), os.path.join(folder, name, "a"))

    def targets(self, folder):
        found = super().targets(folder)
        other = os.path.join(folder, "runs", "a")
        return found + [os.path.join(other, "run.json")] * 6 + below(other, ".exr")


class Shot(Kind):
    name = "shot"
    commands = [("report shot -o out.html", None), ("info shot/f.0001", None), ("check good --baseline shot", (0, 1, 2, 3, 4))]

    def make(self, folder):
        tap.glint("sample", "street", "--light=1", "-o", os.path.join(folder, "f.exr"), "--size", "16x9", "--cube-size", "8", "--frames", "2")
        tap.glint("replay", "f.0001.exr", "f.0002.exr", "-p", tap.PLAIN, "-o", "shot", folder=folder)
        shutil.copytree(os.path.join(folder, "shot"), os.path.join(folder, "good"))

    def targets(self, folder):
        return below(os.path.join(folder, "shot"), ".json") * 3 + below(os.path.join(folder, "shot"), ".exr")


class Preset(Kind):
    name = "preset"
    environment = {"GLINT_PRESETS": "presets"}
    given = ("preset.json",)
    named = "[a-z_]+/[a-z_0-9]+"  # a pipeline that does not fit together is told by its slots
    commands = [("plan tiny.exr -p preset.json", None), ("plan tiny.exr -p named", None)]

    def make(self, folder):
        small_capture(folder)
        presets = os.path.join(os.path.dirname(tap.PLAIN), "..", "samples", "presets")
        shutil.copy(os.path.join(presets, "mafia3.json"), os.path.join(folder, "preset.json"))
        os.mkdir(os.path.join(folder, "presets"))
        shutil.copy(os.path.join(presets, "kf2.json"), os.path.join(folder, "presets", "named.json"))

    def targets(self, folder):
        return [os.path.join(folder, "preset.json"), os.path.join(folder, "presets", "named.json")]


class Manifest(Kind):
    name = "manifest"
    commands = [("pack loose/manifest.json -o out.exr", None), ("pack loose/manifest.json --explain", None)]

    def make(self, folder):
        small_capture(folder)
        tap.glint("extract", "tiny.exr", "-o", "loose", folder=folder)

    def targets(self, folder):
        return [os.path.join(folder, "loose", "manifest.json")] * 8 + below(os.path.join(folder, "loose"), ".raw", ".npy", ".exr")


def png(width, height):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes((x * 7 + y) % 256 for x in range(3 * width)) for y in range(height))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def gltf_scene():
    """A square with texture, normals, a sparse accessor and a camera: its JSON and the bytes of its buffer."""
    positions = struct.pack("<12f", -2, 0, -2, 2, 0, -2, 2, 0, 2, -2, 0, 2)
    places = struct.pack("<8f", 0, 0, 1, 0, 1, 1, 0, 1)
    indices = struct.pack("<6H", 0, 2, 1, 0, 3, 2)
    data = positions + places + indices + struct.pack("<2H", 1, 2) + struct.pack("<6f", 0, 1, 0, 0, 1, 0)
    scene = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "matrix": [2, 0, 0, 0, 0, 0.8, 0.6, 0, 0, -1.8, 2.4, 0, 0, 0, 0, 1]}, {"camera": 0, "translation": [0.5, 1, 6], "children": [2]}, {"name": "empty"}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1, "aspectRatio": 1.5}}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.4, 0.6, 1], "metallicFactor": 0.25, "roughnessFactor": 0.5, "baseColorTexture": {"index": 0}},
                       "emissiveFactor": [0, 1, 0], "alphaMode": "MASK", "alphaCutoff": 0.5}],
        "textures": [{"source": 0, "sampler": 0}], "samplers": [{"wrapS": 33071, "wrapT": 10497}], "images": [{"uri": "color.png"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 2, "NORMAL": 3}, "indices": 1, "material": 0}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-2, 0, -2], "max": [2, 0, 2]},
                      {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}, {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
                      {"componentType": 5126, "count": 4, "type": "VEC3", "bufferView": 0,
                       "sparse": {"count": 2, "indices": {"bufferView": 3, "componentType": 5123}, "values": {"bufferView": 4}}}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 32}, {"buffer": 0, "byteOffset": 80, "byteLength": 12},
                        {"buffer": 0, "byteOffset": 92, "byteLength": 4}, {"buffer": 0, "byteOffset": 96, "byteLength": 24}],
        "buffers": [{"byteLength": 120, "uri": "square.bin"}],
    }
    return scene, data


def glb(text, data):
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    return struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)) + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data


class Gltf(Kind):
    name = "gltf"
    given = ("scene.gltf", "scene.glb")
    commands = [("sample scene.gltf -o out.exr --size 16x9 --cube-size 4", None), ("sample scene.glb -o out.exr --size 16x9 --cube-size 4", None)]

    def make(self, folder):
        scene, data = gltf_scene()
        write(os.path.join(folder, "scene.gltf"), json.dumps(scene).encode())
        write(os.path.join(folder, "square.bin"), data)
        write(os.path.join(folder, "color.png"), png(8, 8))
        scene["images"] = [{"uri": "data:image/png;base64," + base64.b64encode(png(8, 8)).decode()}]
        del scene["buffers"][0]["uri"]
        self.scene, self.data = json.dumps(scene).encode(), data
        write(os.path.join(folder, "scene.glb"), glb(self.scene, data))

    def targets(self, folder):
        return [os.path.join(folder, name) for name in ["scene.gltf"] * 4 + ["scene.glb", "square.bin", "color.png"]]

    def mutate(self, folder, rng, secret):
        done, env = super().mutate(folder, rng, secret)
        path = os.path.join(folder, "scene.glb")
        if rng.random() < 0.5 and os.path.isfile(path) and not os.path.islink(path):
            write(path, glb(mutate_json(self.scene, rng), self.data))  # with right lengths in its headers
            done.append("scene.glb: mutate_json")
        return done, env


LUT = """Version 1
From 0.0 1.0
Length 4
Components 1
{
0.0
0.25
0.5
1.0
}
"""


class Ocio(Kind):
    name = "ocio"
    environment = {"OCIO": "config.ocio"}
    given = ("config.ocio",)
    commands = [("view good -o out.png --ocio config.ocio", None), ("view good -o out.png --ocio config.ocio --view LUT", None), ("view good -o out.png --view LUT", None)]

    def make(self, folder):
        small_run(folder)
        shutil.rmtree(os.path.join(folder, "run"))
        text = read(os.path.join(os.path.dirname(tap.PLAIN), "..", "viewer-cli", "draw", "glint.ocio")).decode()
        text = text.replace('search_path: ""', "search_path: luts").replace("active_views: [", "active_views: [LUT, ")
        text = text.replace("    - !<View> {name: raw, colorspace: raw}\n", "    - !<View> {name: raw, colorspace: raw}\n    - !<View> {name: LUT, colorspace: table}\n")
        text += "\n  - !<ColorSpace>\n    name: table\n    isdata: false\n    from_scene_reference: !<FileTransform> {src: ramp.spi1d, interpolation: linear}\n"
        write(os.path.join(folder, "config.ocio"), text.encode())
        os.mkdir(os.path.join(folder, "luts"))
        write(os.path.join(folder, "luts", "ramp.spi1d"), LUT.encode())

    def targets(self, folder):
        return [os.path.join(folder, "config.ocio")] * 3 + [os.path.join(folder, "luts", "ramp.spi1d")]


class Journal(Kind):
    name = "journal"
    slow = device = True
    timeout_s = 60
    commands = [("sweep tiny.exr -o sweep -p PLAIN --vary screen_trace.steps=4,8 --repeat 1", None), ("report sweep -o out.html", None), ("report compare -o out.html", None),
                ("reference tiny.exr -o reference --rays 16", None)]
    makes = ["sweep tiny.exr -o sweep -p PLAIN --vary screen_trace.steps=4,8 --repeat 1", "compare tiny.exr --presets PLAIN -o compare --repeat 1",
             "reference tiny.exr -o reference --rays 16"]

    def make(self, folder):
        small_capture(folder)
        for line in self.makes:
            tap.glint(*line.replace("PLAIN", tap.PLAIN).split(), folder=folder)

    def targets(self, folder):
        return [path for name in ("sweep", "compare", "reference") for path in below(os.path.join(folder, name), ".json", ".jsonl", ".exr", ".png")]


class Shader(Kind):
    name = "shader"
    slow = device = True
    environment = {"GLINT_PASSES": "passes"}
    given = ("mine/bilinear.comp",)
    timeout_s = 60
    commands = [("replay tiny.exr -p PLAIN -o out --shader upscale=mine/bilinear.comp", None), ("replay tiny.exr -p PLAIN -o out", None)]

    def make(self, folder):
        small_capture(folder)
        passes = os.path.join(os.path.dirname(tap.PLAIN), "..", "passes")
        os.mkdir(os.path.join(folder, "mine"))
        shutil.copy(os.path.join(passes, "reflection", "upscale", "bilinear.comp"), os.path.join(folder, "mine", "bilinear.comp"))
        own = os.path.join(folder, "passes", "reflection", "upscale")
        os.makedirs(own)
        for name in ("bilinear.comp", "bilinear.pass.h"):
            shutil.copy(os.path.join(passes, "reflection", "upscale", name), os.path.join(own, name))

    def targets(self, folder):
        return below(os.path.join(folder, "mine"), ".comp") * 2 + below(os.path.join(folder, "passes"), ".comp", ".h")


class Cache(Kind):
    name = "cache"
    slow = device = True
    environment = {"GLINT_CACHE": "cache"}
    timeout_s = 60
    commands = [("replay tiny.exr -p mafia3 -o out", None), ("reference tiny.exr --rays 16 -o out", None)]

    def make(self, folder):
        small_capture(folder)
        os.environ["GLINT_CACHE"] = os.path.join(folder, "cache")
        tap.glint("replay", "tiny.exr", "-p", "mafia3", "-o", "run", folder=folder)
        tap.glint("reference", "tiny.exr", "--rays", "16", "-o", "traced", folder=folder)
        os.environ["GLINT_CACHE"] = "none"

    def targets(self, folder):
        return below(os.path.join(folder, "cache"), ".exr", ".json")


class Environment(Kind):
    name = "environment"
    device = True
    commands = [("info run", None), ("view run -o out.png", None), ("passes", None), ("plan tiny.exr -p kf2", None), ("lint tiny.exr", None), ("report run -o out.html", None),
                ("--help", None), ("devices", None)]
    variables = ["GLINT_CACHE", "GLINT_CACHE_GIB", "GLINT_PRESETS", "GLINT_PASSES", "GLINT_DEVICE", "GLINT_VALIDATION", "OCIO", "TMPDIR", "HOME", "XDG_CACHE_HOME", "XDG_RUNTIME_DIR", "NO_COLOR", "COLUMNS",
                 "LINES", "TERM", "LANG", "LC_ALL", "LC_NUMERIC", "COLORTERM", "VK_ICD_FILENAMES", "VK_LAYER_PATH", "ARGP_HELP_FMT", "POSIXLY_CORRECT"]

    def make(self, folder):
        small_run(folder)
        shutil.rmtree(os.path.join(folder, "good"))

    def targets(self, folder):
        return []

    def mutate(self, folder, rng, secret):
        values = TEXTS + ["0", "-1", "1", "80", "99999999999999999999", "xterm-256color", "dumb", "de_DE.UTF-8", "C", "tr_TR.UTF-8", "tiny.exr", "run", "/nowhere", "fifo", secret, "rmargin=1", "x=" * 50]
        os.mkfifo(os.path.join(folder, "fifo"))
        env = {rng.choice(self.variables): rng.choice(values) for _ in range(rng.choice([1, 1, 2, 4]))}
        return [f"{k}={v[:40]!r}" for k, v in env.items()], env


class Fix(Kind):
    """Captures that lint has something to say about, and what it writes of them."""
    name = "fix"
    unchanged = (0, 1)
    timeout_s = 60
    commands = [("lint wrong.exr --fix -o fixed.exr", None), ("lint right.exr --fix -o fixed.exr", None)]

    def make(self, folder):
        tap.glint("sample", "street", "--light=1", "-o", os.path.join(folder, "right.exr"), "--size", "64x36", "--cube-size", "8")
        tap.glint("set", "right.exr", "-o", "wrong.exr", "depth=reversed", folder=folder)

    def targets(self, folder):
        return [os.path.join(folder, "wrong.exr"), os.path.join(folder, "right.exr")]

    def after(self, folder):
        return "validate fixed.exr" if os.path.exists(os.path.join(folder, "fixed.exr")) else None


KINDS = [kind() for kind in (Run, Baseline, Shot, Preset, Manifest, Gltf, Ocio, Journal, Shader, Cache, Environment, Fix)]
