"""Captures packed from every listed format, replayed: replays.py GLINT DECODED PAGE [all | K/N], of all pairs of scene and format, or of every
Nth from the Kth on. Each is compared, bit for bit, with the replay of a control that was packed from 64-bit floats: of the original's values where
the format holds them all, else of the nearest values that it holds, as tests/pack/texels.py decodes them, which shares no code with glint. So a
replay may differ from the original's by what half a step of the format changes, and by nothing else. Speaks TAP."""
import os
import random
import re
import struct
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "viewer-cli"))
import packing  # noqa: E402
import tap  # noqa: E402
import texels  # noqa: E402

GLINT, DECODED, PAGE = sys.argv[1:4]
PART = [int(n) for n in sys.argv[4].replace("all", "0/1").split("/")] if sys.argv[4:] else None
COUNT = 3
W, H = 24, 16
DOUBLE = "VK_FORMAT_R64_SFLOAT"


def listed():
    """The formats of the page's table, by either name, without those whose names do not say how they are laid out."""
    with open(PAGE, encoding="utf-8") as file:
        rows = file.read().split("<!-- table formats -->")[1].split("<!-- end -->")[0].split("\n")[3:]
    for row in filter(None, rows):
        for prefix, cell in zip(("VK_FORMAT_", "DXGI_FORMAT_"), row.split("|")[1:3]):
            yield from (prefix + name for name in re.findall(r"`([^`]*)`", cell) if not re.search("TYPELESS|D32_SFLOAT_S8|D32_FLOAT_S8", name))


def channels_for(fmt):
    """What of a G-buffer or of the light the format can hold, by its components."""
    parts, _ = texels.components(fmt)
    letters, kinds = [p[0] for p in parts], {p[3] for p in parts}
    if letters[0] in "ds":
        return ("gbuffer", ["depth.Z"], ["d"]) if letters[0] == "d" else None
    if kinds & {"UINT", "SINT"}:
        return "gbuffer", ["stencil.id"], letters[:1]
    if "SNORM" in kinds:
        return ("gbuffer", ["normal.X", "normal.Y", "normal.Z"], ["r", "g", "b"]) if len(letters) >= 3 else None
    if len(letters) < 3:
        return "gbuffer", ["material.roughness"], letters[:1]
    return ("lit", list("RGB"), list("rgb")) if kinds & {"SFLOAT", "UFLOAT", "SHARED"} else ("gbuffer", [f"albedo.{c}" for c in "RGB"], list("rgb"))


class Tests:
    def __init__(self, folder):
        self.folder, self.bases, self.rng = folder, {}, random.Random(20)

    def base(self, scene):
        if scene not in self.bases:
            folder = os.path.join(self.folder, scene)
            os.makedirs(folder)
            base = packing.Base(GLINT, folder, scene, "--truth=1")
            self.bases[scene] = base, packing.Capture(DECODED, base.capture)
        return self.bases[scene]

    def replayed(self, capture):
        out = capture[:-4] + "-run"
        if not os.path.exists(out):
            subprocess.run([GLINT, "replay", capture, "-o", out], check=True, capture_output=True)
        return out

    def compare(self, scene, fmt):
        """Returns whether the format holds the original's values, None if no role takes it."""
        base, original = self.base(scene)
        chosen = channels_for(fmt)
        if not chosen or any(c not in original.parts[chosen[0]] for c in chosen[1]):
            return None
        part, channels, letters = chosen
        integer = channels == ["stencil.id"]
        values = [struct.unpack(f"<{W * H}{'I' if integer else 'f'}", original.parts[part][c]) for c in channels]
        frame, extra = {}, {}
        if channels == ["depth.Z"]:
            near = 0.05
            frame["view_to_clip"] = [n if i not in (10, 11) else (0.0, near)[i - 10] for i, n in enumerate(original.frame["view_to_clip"])]
            values, extra = [[0.0 if v == float("inf") else near / v for v in values[0]]], {"depth": "reversed_infinite"}
        fields = {p[0]: p for p in texels.components(fmt)[0]}
        held, data = [[] for _ in letters], b""
        for i in range(W * H):
            texel = texels.encode_texel({letter: v[i] for letter, v in zip(letters, values)}, fmt)
            word, data = int.from_bytes(texel, "little"), data + texel
            for k, letter in enumerate(letters):
                _, first, bits, kind = fields[letter]
                held[k].append(texels.decode((word >> first) & ((1 << bits) - 1), letter, bits, kind, word))
        part_values = dict(base.manifest["parts"][part], encodings=dict(base.manifest["parts"][part].get("encodings", {}), **extra))
        captures = []
        for kind in ("packed", "control"):
            textures, words = {}, dict(part_values)
            if kind == "packed":
                self.write(base, f"{fmt}.bin", data)
                textures["t"] = {"file": f"{fmt}.bin", "format": fmt, "width": W, "height": H}
            for k, (channel, letter) in enumerate(zip(channels, letters)):
                texture = "t" if kind == "packed" else f"t{k}"
                if kind == "control":
                    self.write(base, f"{fmt}-{k}.bin", struct.pack(f"<{W * H}d", *held[k]))
                    textures[texture] = {"file": f"{fmt}-{k}.bin", "format": DOUBLE, "width": W, "height": H}
                words[channel] = {"texture": texture, "channel": letter if kind == "packed" else "r", "type": "uint" if integer else "float"}
            path = base.write(f"{fmt}-{kind}", base.changed(frame, textures, {part: words}))
            captures.append(os.path.join(base.folder, f"{fmt}-{kind}.exr"))
            base.run("pack", path, "-o", captures[-1])
        self.same(*captures)
        lossless = not frame and all(struct.pack("<f", a) == struct.pack("<f", b) for h, v in zip(held, values) for a, b in zip(h, v))
        if lossless:
            self.same(captures[0], base.capture)
        return lossless

    def write(self, base, name, data):
        with open(os.path.join(base.folder, name), "wb") as file:
            file.write(data)

    def same(self, one, other):
        run = subprocess.run([GLINT, "diff", self.replayed(one), self.replayed(other)], capture_output=True, text=True)
        assert run.returncode == 0, (one, other, run.stdout[-1500:], run.stderr[-500:])

    def test_formats_replay_as_the_values_that_they_hold(self):
        scenes = [line.split()[0] for line in subprocess.run([GLINT, "sample", "--list"], capture_output=True, text=True, check=True).stdout.split("\n")[1:]
                  if line.strip()]
        formats = list(listed())
        assert len(formats) > 100, len(formats)
        pairs = [(s, f) for s in scenes for f in formats if channels_for(f)]
        lossless = ["VK_FORMAT_R32_SFLOAT", "VK_FORMAT_R32G32B32_SFLOAT", "DXGI_FORMAT_R32G32B32A32_FLOAT"]
        chosen = pairs[PART[0]::PART[1]] if PART else self.rng.sample(pairs, COUNT) + [("street", lossless[0]), ("street", lossless[1])]
        found, different = [], []
        for scene, fmt in chosen:
            try:
                found.append((fmt, self.compare(scene, fmt)))
                said = "as the original" if found[-1][1] else "as its control"
            except AssertionError as error:
                different.append((scene, fmt, str(error)))
                said = "different"
            if PART:
                print(f"# {scene}, {fmt}: {said}", flush=True)
        assert not different, f"{len(different)} of {len(chosen)}: {different}"
        assert all(kept for fmt, kept in found if fmt in lossless), found
        print(f"# {sum(kept is not None for _, kept in found)} replayed, {sum(bool(kept) for _, kept in found)} of them as the original")


def main():
    with tempfile.TemporaryDirectory() as folder:
        sys.exit(tap.run(Tests(folder)))


main()
