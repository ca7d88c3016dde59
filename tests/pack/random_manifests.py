"""A capture of a sample scene, dumped COUNT times (30 by default) as some engine might have it, each time in other formats and conventions, packed, and compared with
the original's decoded values: random_manifests.py GLINT DECODED SCHEMA [COUNT]. Speaks TAP."""
import math
import os
import random
import struct
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "viewer-cli"))
import cubes  # noqa: E402
import packing  # noqa: E402
import tap  # noqa: E402
import programs  # noqa: E402
import texels  # noqa: E402

GLINT, DECODED, SCHEMA = sys.argv[1:4]
COUNT = int(sys.argv[4]) if len(sys.argv) > 4 else 30
W, H, N = 24, 16, 4
VIEW, CLIP, PREVIOUS_VIEW, PREVIOUS_CLIP = "world_to_view", "view_to_clip", "previous_world_to_view", "previous_view_to_clip"


def floats(data):
    return list(struct.unpack(f"<{len(data) // 4}f", data))


def transposed(m):
    return [m[4 * c + r] for r in range(4) for c in range(4)]


class Textures:
    """Writes textures in random wrappings."""
    def __init__(self, rng, folder):
        self.rng, self.folder, self.all = rng, folder, {}

    def write(self, name, data):
        with open(os.path.join(self.folder, name), "wb") as file:
            file.write(data)
        return name

    def raw(self, name, fmt, texel_rows, bottom=None, layers=1):
        """texel_rows: rows from the top, of bytes of each texel; of all layers, one after the other."""
        rng, size = self.rng, len(texel_rows[0][0])
        height, width = len(texel_rows) // layers, len(texel_rows[0])
        words = {"format": fmt, "width": width, "height": height}
        bottom = rng.random() < 0.4 if bottom is None else bottom
        rows = texel_rows[::-1] if bottom and layers == 1 else texel_rows
        if bottom:
            words["rows"] = "bottom_first"
        array = "PACK" not in fmt and "D" not in fmt.split("FORMAT_")[1] and fmt.startswith("VK")
        parts, _ = texels.components(fmt)
        pitch = width * size + rng.choice([0, 0, 1, 7, 256 - width * size % 256])
        if array and len(parts) > 1 and layers == 1 and rng.random() < 0.25:
            words["layout"] = "planar"
            data = b"".join(b"".join(t[first // 8:(first + bits) // 8] for t in row) for _, first, bits, _ in parts for row in rows)
            self.all[name] = dict(words, file=self.write(name + ".bin", data))
            return
        if pitch != width * size:
            words["row_pitch"] = pitch
        lines = [b"".join(row) + rng.randbytes(pitch - width * size) for row in rows]
        if layers > 1 and rng.random() < 0.5:
            words["layer_pitch"] = pitch * height + 100
            lines = [line + (bytes(100) if i % height == height - 1 else b"") for i, line in enumerate(lines)]
        offset = rng.choice([0, 0, 5, 128])
        if offset:
            words["offset"] = offset
        self.all[name] = dict(words, file=self.write(name + ".bin", bytes(offset) + b"".join(lines)))

    def store(self, name, fmt, values, width=W):
        """values: a list for each letter. Returns the function of half steps."""
        count = len(next(iter(values.values())))
        packed = [texels.encode_texel({letter: v[i] for letter, v in values.items()}, fmt) for i in range(count)]
        rows = [packed[i:i + width] for i in range(0, count, width)]
        kind = self.rng.random()
        if fmt.startswith("VK_") and "D" not in fmt[10:] and kind < 0.12:
            self.all[name] = {"file": self.write(name + ".ktx2", texels.ktx2(width, len(rows), NUMBERS[fmt], b"".join(packed), zstd=self.rng.random() < 0.5))}
        elif fmt == "VK_FORMAT_R8G8B8A8_UNORM" and kind < 0.5:
            if kind < 0.3:
                file = self.write(name + ".png", texels.png(width, len(rows), 4, 8, [b"".join(row) for row in rows]))
            else:
                file = self.write(name + ".dds", texels.dds(width, len(rows), 28, b"".join(packed),
                                                            masks=self.rng.choice([None, (32, 0xff, 0xff00, 0xff0000, 0xff000000)])))
            self.all[name] = {"file": file}
        elif fmt == "VK_FORMAT_R16G16B16_UNORM" and kind < 0.5:
            self.all[name] = {"file": self.write(name + ".png", texels.png(width, len(rows), 3, 16, [
                b"".join(t[k:k + 1] for t in row for k in (1, 0, 3, 2, 5, 4)) for row in rows]))}
        elif kind < 0.3 and any(word in fmt for word in ("SFLOAT", "R16_UNORM")) and "D" not in fmt[10:]:
            parts, size = texels.components(fmt)
            descr = ("<f" if "FLOAT" in fmt else "<u") + str(size // len(parts))
            shape = (len(rows), width, len(parts)) if len(parts) > 1 else (len(rows), width)
            self.all[name] = {"file": self.write(name + ".npy", texels.npy(shape, descr, b"".join(packed)))}
        else:
            self.raw(name, fmt, rows)
        fields = {letter: (bits, kind) for letter, _, bits, kind in texels.components(fmt)[0]}
        return lambda letter, value: texels.step(value, letter, *fields[letter])


NUMBERS = {}


def read_numbers():
    with open("/usr/include/vulkan/vulkan_core.h", encoding="utf-8") as header:
        for line in header:
            words = line.split()
            if len(words) == 3 and words[0].startswith("VK_FORMAT_") and words[2].rstrip(",").isdigit():
                NUMBERS[words[0]] = int(words[2].rstrip(","))


class Dump:
    """One engine's dump of the base capture."""
    def __init__(self, base, original, seed):
        self.rng, self.base, self.original = random.Random(seed), base, original
        self.textures = Textures(self.rng, base.folder)
        self.seed, self.parts, self.checks = seed, {}, []
        self.mirror = self.rng.random() < 0.5  # of the world along z
        self.gbuffer, self.encodings = {}, {}

    def check(self, part, channel, expected, bound):
        """bound: a number for each value."""
        self.checks.append((part, channel, expected, bound))

    # ---- frame ----
    def frame(self):
        rng, o = self.rng, self.original.frame
        out, down, symmetric, along = {}, rng.random() < 0.5, rng.random() < 0.5, rng.random() < 0.5
        kind = rng.choice(["reversed_infinite", "reversed", "device", "infinite"])
        near, far = 0.05, 400.0
        c, d = {"reversed_infinite": (0.0, near), "reversed": (-near / (far - near), near * far / (far - near)), "device": (far / (far - near), -near * far / (far - near)),
                "infinite": (1.0, -near)}[kind]
        self.depth_encoding, self.project = ("device" if kind == "infinite" else kind), lambda t: c + d / t
        self.slope = abs(d)
        matrices = {}
        for view, clip in ((VIEW, CLIP), (PREVIOUS_VIEW, PREVIOUS_CLIP)):
            v, p = list(o[view]), list(o[clip])
            if self.mirror:
                v = [-x if i % 4 == 2 else x for i, x in enumerate(v)]
            p[10], p[11] = (2 * c - 1 if symmetric else c) * p[14], 2 * d if symmetric else d
            if down:
                p[5], p[6] = -p[5], -p[6]
            if along:  # the view looks along the other z
                v = [-x if i // 4 == 2 else x for i, x in enumerate(v)]
                p = [-x if i % 4 == 2 else x for i, x in enumerate(p)]
            matrices[view], matrices[clip] = v, p
        self.expected = {name: list(m) for name, m in matrices.items()}
        self.exact = rng.random() < 0.6
        if not self.exact:  # matrices without jitter, of both frames
            jitter = o["jitter"]
            before = [matrices[PREVIOUS_CLIP][2] * W / 2 / matrices[PREVIOUS_CLIP][14], matrices[PREVIOUS_CLIP][6] * H / 2 / matrices[PREVIOUS_CLIP][14] * (1 if down else -1)]
            matrices[CLIP][2] = matrices[CLIP][6] = matrices[PREVIOUS_CLIP][2] = matrices[PREVIOUS_CLIP][6] = 0.0
            out.update(jitter=jitter, previous_jitter=before, jitter_in_matrix=False)
        out["clip_y"], out["clip_z"] = "down" if down else "up", "minus_one_to_one" if symmetric else "zero_to_one"
        column_major, row = rng.random() < 0.5, rng.random() < 0.5
        out["layout"], out["vectors"] = "column_major" if column_major else "row_major", "row" if row else "column"
        for name, m in matrices.items():
            m = transposed(m) if column_major != row else m
            out[name] = [m[i:i + 4] for i in range(0, 16, 4)] if rng.random() < 0.3 else m
        right_before = True  # the samples' world
        if rng.random() < 0.5:
            out["handedness"] = "right" if right_before != self.mirror else "left"
        return out

    # ---- G-buffer ----
    def depth(self):
        meters = floats(self.original.parts["gbuffer"]["depth.Z"])
        fmt = self.rng.choice(["VK_FORMAT_D32_SFLOAT", "DXGI_FORMAT_D24_UNORM_S8_UINT", "GL_UNSIGNED_INT_24_8", "VK_FORMAT_D16_UNORM", "VK_FORMAT_R32_SFLOAT",
                               "VK_FORMAT_X8_D24_UNORM_PACK32", "VK_FORMAT_R16_UNORM", "linear32", "linear16", "DXGI_FORMAT_D32_FLOAT_S8X24_UINT", "VK_FORMAT_R64_SFLOAT"])
        ids = list(struct.unpack(f"<{W * H}I", self.original.parts["gbuffer"]["stencil.id"]))
        if fmt.startswith("linear"):
            real = "VK_FORMAT_R" + fmt[6:] + "_SFLOAT"
            step = self.textures.store("depth", real, {"r": meters})
            self.gbuffer["depth.Z"] = "depth.r"
            self.check("gbuffer", "depth.Z", meters, [0 if math.isinf(m) else step("r", m) * 1.001 for m in meters])
            return ids
        far = 0.0 if self.depth_encoding.startswith("reversed") else 1.0
        stored = [far if math.isinf(m) else self.project(m) for m in meters]
        letter = "d" if "D" in fmt.replace("DXGI", "") else "r"
        if fmt == "GL_UNSIGNED_INT_24_8":
            packed = [(round(v * 0xffffff) << 8 | i).to_bytes(4, "little") for v, i in zip(stored, ids)]
            self.textures.raw("depth", "DXGI_FORMAT_R8G8B8A8_UNORM", [packed[k:k + W] for k in range(0, W * H, W)], bottom=True)
            self.textures.all["depth"]["format"] = fmt
            half, letter = 0.5 / 0xffffff, "d"
        elif "S8" in fmt:
            packed = [texels.encode_texel({"d": v, "s": i}, fmt.replace("S8X24", "S8")) for v, i in zip(stored, ids)]
            packed = [t.ljust(8, b"\x5a") if "32" in fmt else t for t in packed]
            self.textures.raw("depth", fmt, [packed[k:k + W] for k in range(0, W * H, W)])
            half = 0.5 / 0xffffff if "24" in fmt else 2 ** -24
        else:
            step = self.textures.store("depth", fmt, {letter: stored})
            half = max(step(letter, 1.0), 2 ** -25)
        self.gbuffer["depth.Z"] = "depth." + letter
        if letter == "r" or self.rng.random() < 0.5:
            self.encodings["depth"] = self.depth_encoding
        bounds = []
        for m, v in zip(meters, stored):
            reached = half + 2 ** -25  # and the capture's float
            bounds.append(math.inf if reached >= abs(v - far) and not math.isinf(m) else 0 if math.isinf(m) else m * m / self.slope * reached / max(0.01, 1 - m / self.slope * reached) + 1e-6 * m)
        self.check("gbuffer", "depth.Z", meters, bounds)
        if "s" in texels_letters(fmt):
            self.gbuffer["stencil.id"] = "depth.s"
            self.check("gbuffer", "stencil.id", ids, None)
            return None
        return ids

    def stencil(self, ids):
        if ids is None:
            return
        fmt = self.rng.choice(["VK_FORMAT_S8_UINT", "VK_FORMAT_R8_UINT", "VK_FORMAT_R16_UINT", "VK_FORMAT_R32_UINT", "VK_FORMAT_R8G8B8A8_UINT"])
        letter = "s" if "S8" in fmt else "r"
        self.textures.store("ids", fmt, {letter: ids})
        self.gbuffer["stencil.id"] = "ids." + letter
        self.check("gbuffer", "stencil.id", ids, None)

    def normals(self, part, key, layer, channels):
        """Chooses a format; channels: X, Y, Z of the original."""
        x, y, z = (floats(c) for c in channels)
        z = [-v for v in z] if self.mirror else z
        kind = self.rng.choice(["signed", "unorm", "scaled", "octahedral"])
        swizzle = self.rng.choice(["rgb", "bgr", "grb"])
        sets = {"signed": ["VK_FORMAT_R8G8B8A8_SNORM", "VK_FORMAT_R16G16B16A16_SNORM", "VK_FORMAT_R16G16B16A16_SFLOAT", "VK_FORMAT_R32G32B32_SFLOAT", "VK_FORMAT_A2B10G10R10_SNORM_PACK32"],
                "unorm": ["VK_FORMAT_A2B10G10R10_UNORM_PACK32", "VK_FORMAT_R8G8B8_UNORM", "VK_FORMAT_R8G8B8A8_UNORM", "VK_FORMAT_A2R10G10B10_UNORM_PACK32", "VK_FORMAT_R16G16B16_UNORM"],
                "octahedral": ["VK_FORMAT_R16G16_UNORM", "VK_FORMAT_R8G8_UNORM", "VK_FORMAT_R16G16_SFLOAT", "VK_FORMAT_R32G32_SFLOAT"]}
        fmt = self.rng.choice(sets["unorm" if kind == "scaled" else kind])
        if kind == "octahedral":
            first, second = [], []
            for a, b, c in zip(x, y, z):
                s = abs(a) + abs(b) + abs(c) or 1
                p, q = a / s, b / s
                if c < 0:
                    p, q = math.copysign(1 - abs(q), p), math.copysign(1 - abs(p), q)
                first.append((p + 1) / 2)
                second.append((q + 1) / 2)
            step = self.textures.store(key, fmt, {"r": first, "g": second})
            self.gbuffer[layer] = key + ".rg"
            bound, say = 6 * math.sqrt(2) * step("r", 1.0), True
        else:
            shift = (lambda v: v) if kind == "signed" else (lambda v: (v + 1) / 2)
            values = dict(zip(swizzle, ([shift(v) for v in axis] for axis in (x, y, z))))
            step = self.textures.store(key, fmt, values)
            self.gbuffer[layer] = {"texture": key, "channel": swizzle, "scale": 2, "offset": -1} if kind == "scaled" else f"{key}.{swizzle}"
            bound, say = math.sqrt(3) * step("r", 1.0) * (1 if kind == "signed" else 2), self.rng.random() < 0.5 or kind == "scaled"
            self.textures.all[key].pop("transfer", None)
        if say or "npy" in self.textures.all[key]["file"]:
            self.encodings["normal" if layer == "normal" else "vertex_normal"] = "signed" if kind == "scaled" else kind
        for axis, values in zip("XYZ", (x, y, z)):
            self.check(part, f"{layer}.{axis}", values, [bound * 1.01 + 1e-6] * len(values))

    def numbers(self):
        rng, part = self.rng, self.original.parts["gbuffer"]
        rough, metal, specular = (floats(part["material." + name]) for name in ("roughness", "metalness", "specular"))
        gloss = rng.random() < 0.5
        fmt = rng.choice(["VK_FORMAT_R8G8B8A8_UNORM", "VK_FORMAT_B8G8R8A8_UNORM", "VK_FORMAT_R5G6B5_UNORM_PACK16", "DXGI_FORMAT_B5G5R5A1_UNORM", "VK_FORMAT_R16G16B16_UNORM",
                          "VK_FORMAT_R4G4B4A4_UNORM_PACK16", "VK_FORMAT_R16G16B16A16_SFLOAT", "DXGI_FORMAT_R32G32B32A32_FLOAT", "VK_FORMAT_A8B8G8R8_UNORM_PACK32"])
        letters = rng.sample("rgb", 3)
        stored = [1 - v for v in rough] if gloss else rough
        step = self.textures.store("material", fmt, dict(zip(letters, (stored, metal, specular))))
        if gloss:
            self.encodings["roughness"] = "gloss"
        for name, letter, values in zip(("roughness", "metalness", "specular"), letters, (rough, metal, specular)):
            self.gbuffer["material." + name] = f"material.{letter}" if rng.random() < 0.5 else {"texture": "material", "channel": letter}
            self.check("gbuffer", "material." + name, values, [step(letter, 1.0) * 1.01 + 1e-3 * step(letter, v) + 2 ** -11 * (fmt.endswith("UNORM") or "PACK" in fmt) * v + 1e-7 for v in values])

    def colors(self, part, key, channels, formats, out, prefix=""):
        values = {letter: floats(channels[name]) for letter, name in zip("rgb", channels)}
        fmt = self.rng.choice(formats)
        step = self.textures.store(key, fmt, values)
        names = list(channels)
        out["RGB" if not prefix else prefix] = key + ".rgb"
        # shared exponents follow the largest component; UNORM of 8 bits is kept in half
        top = [max(v) for v in zip(*values.values())]
        for letter, name in zip("rgb", names):
            self.check(part, name, values[letter], [step(letter, t if "E5" in fmt else v) * 1.01 + (2 ** -11 * v if "NORM" in fmt else 0) + 1e-7 for v, t in zip(values[letter], top)])

    def motion(self):
        x, y = (floats(self.original.parts["gbuffer"]["motion." + axis]) for axis in "XY")
        kind = self.rng.choice(["uv", "ndc", "pixels", "packed16"])
        frame = {}
        if kind == "packed16":
            reach = max(map(abs, x + y)) * 1.1 or 1
            self.textures.store("motion", "VK_FORMAT_R16G16_UINT", {"r": [round(v / reach * 32767) + 32768 for v in x], "g": [round(v / reach * 32767) + 32768 for v in y]})
            frame["motion_range"], bounds = reach, [reach / 65534 * 1.01 + 1e-7] * 2
        else:
            sign = -1 if self.down == "up" else 1
            scale = {"uv": (1, 1), "ndc": (2, 2 * sign), "pixels": (W, H)}[kind]
            fmt = self.rng.choice(["VK_FORMAT_R16G16_SFLOAT", "VK_FORMAT_R32G32_SFLOAT"])
            stored = [v * scale[0] for v in x], [v * scale[1] for v in y]
            step = self.textures.store("motion", fmt, {"r": stored[0], "g": stored[1]})
            bounds = [max(step("r", v) for v in s) / abs(c) * 1.01 + 1e-7 for s, c in zip(stored, scale)]
        self.encodings["motion"] = kind
        self.gbuffer["motion"] = "motion.rg"
        for axis, values, bound in zip("XY", (x, y), bounds):
            self.check("gbuffer", "motion." + axis, values, [bound] * len(values))
        return frame

    # ---- cube maps ----
    def cube(self, part, with_distance):
        n, original = N, self.original.parts[part]
        names = ["R", "G", "B"] + (["A"] if "A" in original else [])
        values = {name: floats(original[name]) for name in names + (["distance.Z"] if with_distance else [])}
        shown = {}  # values by direction of the (perhaps mirrored) world
        expected = {name: [] for name in values}
        for k, face in enumerate(cubes.FACES):
            for j, row in enumerate(cubes.picture(face, n)):
                for i, d in enumerate(row):
                    where = (d[0], d[1], -d[2]) if self.mirror else d
                    shown[where] = {name: v[(k * n + j) * n + i] for name, v in values.items()}
        for face in cubes.FACES:
            for row in cubes.picture(face, n):
                for d in row:
                    for name in values:
                        expected[name].append(shown[d][name])
        layout, words, bottom, grids = cubes.arrange(self.rng, n)
        out = {"cubemap": self.base.manifest["parts"][part]["cubemap"]} if part.startswith("cubemap") else {}
        for key, fmt, channels in (("color", "VK_FORMAT_R16G16B16A16_SFLOAT", names), ("far", "VK_FORMAT_R32_SFLOAT", ["distance.Z"] if with_distance else [])):
            if not channels:
                continue
            texture = f"{part}.{key}"
            images = [[[texels.encode_texel({letter: shown[d][name] if d else 7.0 for letter, name in zip("rgba", channels)}, fmt) for d in row] for row in grid] for grid in grids]
            self.cube_texture(texture, fmt, layout, bottom, images)
            self.textures.all[texture]["cube"] = words
            out["distance.Z" if key == "far" else "RGBA" if "A" in channels else "RGB"] = texture + (".r" if key == "far" else "." + "rgba"[:len(channels)])
        for name, numbers in expected.items():
            self.check(part, name, numbers, [0] * len(numbers))
        self.parts[part] = out

    def cube_texture(self, name, fmt, layout, bottom, images):
        tx, whole = self.textures, [row for image in images for row in image]
        if layout == "files":
            tx.all[name] = {"files": [tx.write(f"{name}{k}.raw", b"".join(b"".join(row) for row in image)) for k, image in enumerate(images)], "format": fmt, "width": N, "height": N}
        elif layout == "layers" and self.rng.random() < 0.5:
            data = b"".join(b"".join(row) for row in whole)
            if self.rng.random() < 0.5:
                tx.all[name] = {"file": tx.write(name + ".ktx2", texels.ktx2(N, N, NUMBERS[fmt], data, faces=6, zstd=self.rng.random() < 0.5, levels=2, before=b"mipmip"))}
            else:
                dxgi = {"VK_FORMAT_R16G16B16A16_SFLOAT": 10, "VK_FORMAT_R32_SFLOAT": 41}[fmt]
                size = len(whole[0][0])  # each face has its chain of two levels
                chains = b"".join(b"".join(b"".join(row) for row in image) + bytes((N // 2) ** 2 * size) for image in images)
                tx.all[name] = {"file": tx.write(name + ".dds", texels.dds(N, N, dxgi, chains, cube=True, mips=2))}
        else:
            tx.raw(name, fmt, whole, bottom=False, layers=6 if layout == "layers" else 1)
            return_rows = tx.all[name]
            return_rows.pop("rows", None)
        if bottom:
            tx.all[name]["rows"] = "bottom_first"

    # ---- all ----
    def make(self):
        frame = self.frame()
        self.down = frame["clip_y"]
        g = self.original.parts["gbuffer"]
        self.stencil(self.depth())
        self.normals("gbuffer", "n", "normal", [g["normal." + a] for a in "XYZ"])
        self.normals("gbuffer", "vn", "vertexNormal", [g["vertexNormal." + a] for a in "XYZ"])
        self.numbers()
        self.colors("gbuffer", "albedo", {"albedo." + c: g["albedo." + c] for c in "RGB"},
                    ["VK_FORMAT_R8G8B8A8_SRGB", "VK_FORMAT_R8G8B8A8_UNORM", "VK_FORMAT_B10G11R11_UFLOAT_PACK32", "VK_FORMAT_E5B9G9R9_UFLOAT_PACK32", "VK_FORMAT_R16G16B16_UNORM",
                     "DXGI_FORMAT_B8G8R8A8_UNORM_SRGB", "VK_FORMAT_R16G16B16_SFLOAT"], self.gbuffer, "albedo")
        frame.update(self.motion())
        self.parts["gbuffer"] = dict(self.gbuffer, encodings=self.encodings)
        lit = {}
        self.colors("lit", "light", {c: self.original.parts["lit"][c] for c in "RGB"},
                    ["VK_FORMAT_R16G16B16A16_SFLOAT", "VK_FORMAT_B10G11R11_UFLOAT_PACK32", "VK_FORMAT_E5B9G9R9_UFLOAT_PACK32", "VK_FORMAT_R32G32B32_SFLOAT", "VK_FORMAT_R16G16B16_SFLOAT"], lit)
        self.parts["lit"] = lit
        for part in ("cubemap.000", "cubemap.001"):
            self.cube(part, True)
        self.cube("sky", False)
        # what this dump does not have
        manifest = self.base.changed(frame, self.textures.all, self.parts)
        manifest["parts"] = {name: part for name, part in manifest["parts"].items() if name in self.parts or name == "previous.lit"}
        used = set(self.textures.all) | {"previous.lit"}
        manifest["textures"] = {name: words for name, words in manifest["textures"].items() if name in used}
        return manifest

    def compare(self, found):
        for name, numbers in self.expected.items():
            for a, b in zip(found.frame[name], numbers):
                assert a == b or (not self.exact and abs(a - b) < 1e-12) or abs(a - b) < 1e-15, (name, found.frame[name], numbers)
        for part, channel, expected, bounds in self.checks:
            data = found.parts[part][channel]
            if bounds is None:
                assert list(struct.unpack(f"<{len(expected)}I", data)) == expected, (part, channel)
                continue
            for i, (got, wanted, bound) in enumerate(zip(floats(data), expected, bounds)):
                assert got == wanted or abs(got - wanted) <= bound or bound == math.inf, (part, channel, i, got, wanted, bound, found.storage[part][channel])


def texels_letters(fmt):
    return "ds" if "S8" in fmt or fmt.endswith("24_8") else "d"


class Tests:
    def __init__(self, folder):
        read_numbers()
        self.base = packing.Base(GLINT, folder, "street")
        self.original = Capture = packing.Capture(DECODED, self.base.capture)
        assert len(Capture.parts) > 5
        self.manifests = []

    def test_random_dumps(self):
        for seed in range(COUNT):
            dump = Dump(self.base, self.original, seed)
            manifest = dump.make()
            path, out = self.base.write(f"dump{seed}", manifest), os.path.join(self.base.folder, "dump.exr")
            self.manifests.append(path)
            try:
                self.base.run("pack", path, "-o", out)
                dump.compare(packing.Capture(DECODED, out))
            except AssertionError as error:
                raise AssertionError(f"seed {seed}: {str(error)[-1500:]}") from error
            if seed % 20 == 0:
                said = subprocess.run([GLINT, "validate", out], capture_output=True, text=True).stdout
                assert "[" not in said or all("[pixels-" in line for line in said.split("\n") if "[" in line), said
        print(f"# {COUNT} dumps")

    def test_schema(self):
        named = [word for path in self.manifests for word in ("-i", path)]
        run = subprocess.run([programs.find("jsonschema"), *named, SCHEMA], capture_output=True, text=True)
        assert run.returncode == 0 and self.manifests, run.stderr[-2000:]


with tempfile.TemporaryDirectory() as temporary:
    sys.exit(tap.run(Tests(temporary)))
