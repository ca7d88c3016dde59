"""Raw texels of RenderDoc's formats as NumPy arrays, and the names that `glint pack` has for them.

A format is a dictionary, as list_passes.py writes it: name, type (Regular, R11G11B10, D24S8, …), components, bytes (of one component),
kind (UNorm, SNorm, UInt, SInt, Float, UNormSRGB, Depth) and bgra.
"""
import numpy as np


class FormatError(Exception):
    """A format that cannot be decoded here."""


WHOLE = {("UNorm", 1): "u1", ("UNorm", 2): "<u2", ("UNorm", 4): "<u4", ("SNorm", 1): "i1", ("SNorm", 2): "<i2", ("UNormSRGB", 1): "u1",
         ("UInt", 1): "u1", ("UInt", 2): "<u2", ("UInt", 4): "<u4", ("SInt", 1): "i1", ("SInt", 2): "<i2", ("SInt", 4): "<i4",
         ("Float", 2): "<f2", ("Float", 4): "<f4", ("Float", 8): "<f8", ("Depth", 2): "<u2", ("Depth", 4): "<f4"}
SUFFIX = {"UNorm": "UNORM", "SNorm": "SNORM", "UInt": "UINT", "SInt": "SINT", "Float": "SFLOAT", "UNormSRGB": "SRGB"}


def bytes_of_texel(form):
    special = {"R11G11B10": 4, "R10G10B10A2": 4, "R9G9B9E5": 4, "D24S8": 4, "D32S8": 8, "D16S8": 4, "R5G6B5": 2, "S8": 1, "A8": 1}
    if form["type"] == "Regular":
        return form["components"] * form["bytes"]
    if form["type"] not in special:
        raise FormatError(f"{form['name']} cannot be decoded; capture the program with texture compression off, or read the image elsewhere")
    return special[form["type"]]


def _small_floats(codes, mantissa):
    """Floats of 5 bits exponent and no sign, as in R11G11B10."""
    exponent, fraction = codes >> mantissa, (codes & ((1 << mantissa) - 1)) / (1 << mantissa)
    value = np.where(exponent == 0, fraction * 2.0**-14, (1 + fraction) * np.exp2(exponent.astype(float) - 15))
    return np.where(exponent == 31, np.where(fraction == 0, np.inf, np.nan), value)


def _packed(words, form, api):
    kind = form["type"]
    if kind == "R11G11B10":
        return [_small_floats(words & 0x7FF, 6), _small_floats(words >> 11 & 0x7FF, 6), _small_floats(words >> 22, 5)]
    if kind == "R10G10B10A2":
        parts = [words & 0x3FF, words >> 10 & 0x3FF, words >> 20 & 0x3FF, words >> 30]
        return parts if form["kind"] == "UInt" else [p / n for p, n in zip(parts, (1023, 1023, 1023, 3))]
    if kind == "R9G9B9E5":
        scale = np.exp2((words >> 27).astype(float) - 24)
        return [(words & 0x1FF) * scale, (words >> 9 & 0x1FF) * scale, (words >> 18 & 0x1FF) * scale]
    # OpenGL's GL_UNSIGNED_INT_24_8 holds depth in the high bits, everyone else in the low ones.
    if api == "OpenGL":
        return [(words >> 8) / 0xFFFFFF, words & 0xFF]
    return [(words & 0xFFFFFF) / 0xFFFFFF, words >> 24]


def decode(raw, form, width, height, api):
    """(height, width, components) in double precision, rows as in memory; sRGB codes become linear, as a sampler has them."""
    size = bytes_of_texel(form) * width * height
    if len(raw) < size:
        raise FormatError(f"{form['name']}, {width} x {height} texels have {size} bytes, found {len(raw)}")
    raw = raw[:size]
    if form["type"] in ("R11G11B10", "R10G10B10A2", "R9G9B9E5", "D24S8"):
        words = np.frombuffer(raw, "<u4").reshape(height, width)
        return np.stack(_packed(words, form, api), axis=-1).astype(float)
    if form["type"] == "D32S8":
        both = np.frombuffer(raw, [("d", "<f4"), ("s", "u1"), ("_", "V3")]).reshape(height, width)
        return np.stack([both["d"], both["s"]], axis=-1).astype(float)
    if form["type"] in ("S8", "A8"):
        return np.frombuffer(raw, "u1").reshape(height, width, 1) / (1.0 if form["type"] == "S8" else 255.0)
    kind = (form["kind"], form["bytes"])
    if form["type"] != "Regular" or kind not in WHOLE:
        raise FormatError(f"{form['name']} cannot be decoded")
    whole = np.frombuffer(raw, WHOLE[kind]).reshape(height, width, form["components"])
    values = whole.astype(float)
    if form["kind"] in ("UNorm", "UNormSRGB", "SNorm") or kind == ("Depth", 2):
        values = np.maximum(values / np.iinfo(whole.dtype).max, -1)
    if form["bgra"] and form["components"] >= 3:
        values[..., [0, 2]] = values[..., [2, 0]]
    if form["kind"] == "UNormSRGB":
        color = values[..., :3]
        values[..., :3] = np.where(color <= 0.04045, color / 12.92, ((color + 0.055) / 1.055) ** 2.4)
    return values


def pack_name(form, api):
    """What `glint pack` calls this format."""
    special = {"R11G11B10": "VK_FORMAT_B10G11R11_UFLOAT_PACK32", "R9G9B9E5": "VK_FORMAT_E5B9G9R9_UFLOAT_PACK32",
               "D32S8": "VK_FORMAT_D32_SFLOAT_S8_UINT",
               "D24S8": "GL_UNSIGNED_INT_24_8" if api == "OpenGL" else "VK_FORMAT_D24_UNORM_S8_UINT"}
    if form["type"] == "R10G10B10A2":
        return f"VK_FORMAT_A2B10G10R10_{SUFFIX[form['kind']]}_PACK32"
    if form["type"] in special:
        return special[form["type"]]
    if form["type"] == "Regular" and form["kind"] == "Depth":
        return {2: "VK_FORMAT_D16_UNORM", 4: "VK_FORMAT_D32_SFLOAT"}[form["bytes"]]
    if form["type"] == "Regular" and form["kind"] in SUFFIX:
        letters = ("BGRA" if form["bgra"] else "RGBA")[:form["components"]]
        return "VK_FORMAT_" + "".join(f"{c}{8 * form['bytes']}" for c in letters) + "_" + SUFFIX[form["kind"]]
    raise FormatError(f"{form['name']}: glint pack has no name for it; give the texture an expression, so that it is decoded first")
