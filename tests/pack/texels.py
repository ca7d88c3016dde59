"""Texels of raw memory and of image files, written and read by what the formats' names say: independent of pack's own table."""
import math
import re
import struct
import zlib

FIELD = re.compile(r"([RGBADSXE])(\d+)")


def components(name):
    """(letter, first bit, bits, kind) of each component, and the bytes of a texel. Direct3D and Vulkan's arrays list from the lowest bit, Vulkan's
    packed formats from the highest."""
    api, rest = re.match(r"(VK_FORMAT|DXGI_FORMAT)_(.*)", name).groups()
    packed = api == "VK_FORMAT" and "PACK" in rest
    rest = re.sub(r"_PACK\d+", "", rest)
    out, at, total = [], 0, 0
    groups = re.findall(r"((?:[RGBADSXE]\d+)+)(?:_(?!S8_|X8_|X8X24|S8X24|D24)([A-Z]+(?:_SRGB)?))?", rest.replace("X8_D24_UNORM", "X8D24_UNORM"))
    fields = []
    for letters, kind in groups:
        fields += [(letter, int(bits), kind) for letter, bits in FIELD.findall(letters)]
    last = next(kind for _, _, kind in reversed(fields) if kind) if any(k for _, _, k in fields) else ""
    fields = [(letter, bits, kind or last) for letter, bits, kind in fields]
    if packed:
        fields.reverse()
    for letter, bits, kind in fields:
        if letter not in "XE":
            out.append((letter.lower(), at, bits, kind))
        at += bits
        total += bits
    if "E5" in rest:
        out = [(letter, first, bits, "SHARED") for letter, first, bits, _ in out]
    return out, (total + 7) // 8


def small_float(code, bits):
    digits = bits - 5
    exponent, mantissa = code >> digits, code & ((1 << digits) - 1)
    if exponent == 31:
        return math.nan if mantissa else math.inf
    return math.ldexp(mantissa, -14 - digits) if exponent == 0 else math.ldexp(mantissa + (1 << digits), exponent - 15 - digits)


def srgb_to_linear(v):
    return v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4


def linear_to_srgb(v):
    return v * 12.92 if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055


def signed(code, bits):
    return code - (1 << bits) if code >> (bits - 1) else code


def decode(code, letter, bits, kind, word):
    """The value that a component's bits stand for. `word`: the whole texel."""
    if kind == "SHARED":
        return math.ldexp(code, (word >> 27) - 24)
    if "SRGB" in kind and letter in "rgb":
        return srgb_to_linear(code / 255)
    if kind in ("UNORM", "SRGB", "UNORM_SRGB"):
        return code / ((1 << bits) - 1)
    if kind == "SNORM":
        return max(-1, signed(code, bits) / ((1 << (bits - 1)) - 1))
    if kind == "UINT":
        return code
    if kind == "SINT":
        return signed(code, bits)
    if bits in (10, 11):
        return small_float(code, bits)
    return struct.unpack({16: "<e", 32: "<f", 64: "<d"}[bits], code.to_bytes(bits // 8, "little"))[0]


def encode(value, letter, bits, kind):
    """The nearest code; SHARED is encoded by encode_texel."""
    if "SRGB" in kind and letter in "rgb":
        value = linear_to_srgb(min(max(value, 0), 1))
    if kind in ("UNORM", "SRGB", "UNORM_SRGB"):
        return round(min(max(value, 0), 1) * ((1 << bits) - 1))
    if kind == "SNORM":
        return round(min(max(value, -1), 1) * ((1 << (bits - 1)) - 1)) & ((1 << bits) - 1)
    if kind in ("UINT", "SINT"):
        return int(value) & ((1 << bits) - 1)
    if bits in (10, 11):
        if value == math.inf:
            return 31 << (bits - 5)
        digits = bits - 5
        value = min(max(value, 0), small_float((31 << digits) - 1, bits))
        exponent = max(math.frexp(value)[1] - 1, -14) if value else -14
        return round(math.ldexp(value, digits - exponent)) + ((exponent + 14) << digits)
    return int.from_bytes(struct.pack({16: "<e", 32: "<f", 64: "<d"}[bits], value), "little")


def encode_texel(values, name):
    """values: by letter; letters that are not there become 0."""
    parts, size = components(name)
    word = 0
    if parts[0][3] == "SHARED":
        top = max(min(values.get(c, 0), 65408) for c in "rgb")
        exponent = max(0, (math.frexp(top)[1] if top else -15) + 15)
        if round(math.ldexp(top, 24 - exponent)) > 511:
            exponent += 1
        word = exponent << 27
    for letter, first, bits, kind in parts:
        value = values.get(letter, 0)
        code = round(math.ldexp(min(value, 65408), 24 - exponent)) if kind == "SHARED" else encode(value, letter, bits, kind)
        word |= code << first
    return word.to_bytes(size, "little")


def step(value, letter, bits, kind):
    """Half the distance of neighbouring values around `value`: what rounding may change."""
    if "SRGB" in kind and letter in "rgb":
        v = linear_to_srgb(min(max(value, 0), 1))
        return srgb_to_linear(min(1, v + 0.5 / 255)) - srgb_to_linear(max(0, v - 0.5 / 255))
    if kind in ("UNORM", "SRGB", "UNORM_SRGB"):
        return 0.5 / ((1 << bits) - 1)
    if kind == "SNORM":
        return 0.5 / ((1 << (bits - 1)) - 1)
    if kind in ("UINT", "SINT") or bits >= 32:
        return 0
    digits = {16: 10, 11: 6, 10: 5}.get(bits, 8)
    return math.ldexp(abs(value), -digits - 1) + math.ldexp(1, -15 - digits)


# ---- Image files ----

def png(width, height, channels, bits, rows):
    """rows: bytes of each row, big-endian for 16 bits."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    color = {1: 0, 2: 4, 3: 2, 4: 6}[channels]
    head = struct.pack(">IIBBBBB", width, height, bits, color, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows))) + chunk(b"IEND", b""))


def npy(shape, descr, data):
    head = f"{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}"
    head += " " * (63 - (len(head) + 10) % 64) + "\n"
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(head)) + head.encode() + data


def hdr(width, height, texels):
    """Radiance's RGBE without run lengths, of (r, g, b)."""
    out = bytearray(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode())
    for texel in texels:
        top = max(texel)
        exponent = math.frexp(top)[1] if top > 1e-30 else 0
        out += bytes(min(255, int(math.ldexp(c, 8 - exponent))) for c in texel) + bytes([exponent + 128 if top > 1e-30 else 0])
    return bytes(out)


def dds(width, height, dxgi, data, cube=False, mips=1, masks=None):
    caps2 = 0xfe00 if cube else 0
    head = b"DDS " + struct.pack("<7I", 124, 0x1007, height, width, 0, 0, mips) + bytes(44)
    if masks:
        head += struct.pack("<8I", 32, 0x41, 0, masks[0], *masks[1:])
    else:
        head += struct.pack("<2I4s5I", 32, 4, b"DX10", 0, 0, 0, 0, 0)
    head += struct.pack("<5I", 0x1000, caps2, 0, 0, 0)
    return head + (b"" if masks else struct.pack("<5I", dxgi, 3, 4 if cube else 0, 1, 0)) + data


def ktx2(width, height, vulkan, data, faces=1, zstd=False, levels=1, before=b""):
    """One level of interest, the first; `before` lies between index and data."""
    stored = zstd_stored(data) if zstd else data
    first = 80 + 24 * levels + len(before)
    head = b"\xabKTX 20\xbb\r\n\x1a\n" + struct.pack("<9I", vulkan, 1, width, height, 0, 0, faces, levels, 2 if zstd else 0) + bytes(32)
    index = struct.pack("<3Q", first, len(stored), len(data)) + bytes(24 * (levels - 1))
    return head + index + before + stored


def zstd_stored(data):
    """A frame of zstd whose blocks are not compressed."""
    out = bytearray(struct.pack("<IBI", 0xfd2fb528, 0xa0, len(data)))
    for at in range(0, max(len(data), 1), 100000):
        piece = data[at:at + 100000]
        out += struct.pack("<I", (at + 100000 >= len(data)) | len(piece) << 3)[:3] + piece
    return bytes(out)
