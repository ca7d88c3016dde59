"""Every format of pack's table, with random bits: every_format.py GLINT DECODED PACK_MD VULKAN_HEADER. Speaks TAP."""
import json
import math
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

GLINT, DECODED, PAGE, VULKAN = sys.argv[1:]
W, H = 5, 3


def formats():
    """Vulkan's and Direct3D's names of each row of the page's table."""
    with open(PAGE, encoding="utf-8") as file:
        table = file.read().split("<!-- table formats -->")[1].split("<!-- end -->")[0]
    return [(re.findall(r"`([^`]*)`", row.split("|")[1]), re.findall(r"`([^`]*)`", row.split("|")[2]), row) for row in table.split("\n")[3:] if row]


def same(found, expected):
    """Whether 32 bits of float are the value, rounded to float, or to half where the capture holds half."""
    got = struct.unpack("<f", found)[0]
    if math.isnan(expected):
        return math.isnan(got)
    options = [struct.pack("<f", expected)] if abs(expected) < 3.4e38 or math.isinf(expected) else [struct.pack("<f", math.copysign(math.inf, expected))]
    if abs(expected) <= 65504:
        options.append(struct.pack("<f", struct.unpack("<e", struct.pack("<e", expected))[0]))
    return found in options


class Tests:
    def __init__(self, folder):
        self.folder = folder
        self.base = packing.Base(GLINT, folder, "mirror_box")

    def test_bits_of_every_format(self):
        rng = random.Random(20)
        parts, textures, expected = {}, {}, {}
        names = [prefix + name for vulkan, dxgi, _ in formats() for prefix, some in (("VK_FORMAT_", vulkan), ("DXGI_FORMAT_", dxgi)) for name in some
                 if not re.search("R24G8_TYPELESS|R32G8X24_TYPELESS|TYPELESS_G8", name)]
        assert len(names) > 130, len(names)
        for name in names:
            fields, size = texels.components(name.replace("R24_UNORM_X8_TYPELESS", "D24_UNORM_X8_UNORM").replace("R32_FLOAT_X8X24_TYPELESS", "D32_FLOAT"))
            size = {"VK_FORMAT_D32_SFLOAT_S8_UINT": 8, "DXGI_FORMAT_R32_FLOAT_X8X24_TYPELESS": 8}.get(name, size)
            pitch, offset = W * size + rng.randrange(9), rng.randrange(70)
            data = rng.randbytes(offset + pitch * (H - 1) + W * size)
            with open(os.path.join(self.folder, name + ".raw"), "wb") as file:
                file.write(data)
            textures[name] = {"file": name + ".raw", "format": name, "width": W, "height": H, "row_pitch": pitch, "offset": offset}
            parts["engine." + name] = {letter: {"texture": name, "channel": letter} for letter, *_ in fields}
            for letter, first, bits, kind in fields:
                for i in range(W * H):
                    at = offset + i // W * pitch + i % W * size
                    word = int.from_bytes(data[at:at + size], "little")
                    code = word >> first & ((1 << bits) - 1)
                    expected[name, letter, i] = kind, texels.decode(code, letter, bits, kind, word)
        found = self.base.pack(DECODED, "formats", {}, textures, parts)
        checked = 0
        for (name, letter, i), (kind, value) in expected.items():
            bits = found.parts["engine." + name][letter][4 * i:4 * i + 4]
            good = struct.unpack("<I", bits)[0] == value if kind == "UINT" else same(bits, value)
            assert good, (name, letter, i, kind, value, struct.unpack("<f", bits), bits.hex())
            checked += 1
        print(f"# {checked} values of {len(names)} names")

    def test_numbers_of_vulkan_are_those_of_its_header(self):
        with open(VULKAN, encoding="utf-8") as file:
            header = dict(re.findall(r"VK_FORMAT_(\w+) = (\d+)", file.read()))
        checked = 0
        for vulkan, _, row in formats():
            for name in vulkan:
                fields, size = texels.components("VK_FORMAT_" + name)
                if "_S8_UINT" in name:
                    continue
                data = bytes(range(100))[:size]
                texture = {"file": "one.ktx2"}
                with open(os.path.join(self.folder, "one.ktx2"), "wb") as file:
                    file.write(texels.ktx2(1, 1, int(header[name]), data))
                said = self.base.explain({"one": texture}, {"engine.one": {"c": {"texture": "one", "channel": fields[0][0]}}})
                assert f"textures.one: 1 x 1 texels of VK_FORMAT_{name}," in said, (name, said)
                checked += 1
        assert checked > 70, checked

    def test_names_that_are_none(self):
        for name, words in (("VK_FORMAT_R8G8B8A8_UNROM", 'did you mean VK_FORMAT_R8G8B8A8_UNORM?'), ("R8_UNORM", "begins with VK_FORMAT_ or DXGI_FORMAT_"),
                            ("DXGI_FORMAT_R8G8B8A8_TYPELESS", "does not say how to read its bits"), ("VK_FORMAT_BC1_RGB_UNORM_BLOCK", "compressed blocks")):
            said = self.base.explain({"t": {"file": "x.raw", "format": name, "width": 1, "height": 1}}, {"engine.t": {"c": "t.r"}}, status=1, file=b"\0" * 16)
            assert words in said and "textures.t.format" in said, said


with tempfile.TemporaryDirectory() as temporary:
    sys.exit(tap.run(Tests(temporary)))
