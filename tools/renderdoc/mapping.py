"""Applies a mapping to one or two frames: finds passes, reads images, computes expressions, and makes the manifest of `glint pack`.

What it needs of a frame is three things, so that tests can do without RenderDoc: `passes` (the list of list_passes.py), `api`, and
`read(event, texture, mip, layer)`, which gives raw bytes, width and height.
"""
import json
import os

import numpy as np

import find
import texels
from expressions import Evaluator, ExpressionError, describe, suggest

SECTIONS = {"$schema", "comment", "glint_mapping", "passes", "images", "constants", "values", "textures", "manifest"}
IMAGE_KEYS = {"pass", "sampler", "output", "depth", "storage_image", "mip", "layer", "rows", "comment"}
CONSTANT_KEYS = {"pass", "block", "member", "comment"}
TEXTURE_KEYS = {"image", "expression", "frame", "comment"}


class MappingError(Exception):
    """A fault of the mapping, or a frame that it does not fit."""


class NeedsPrevious(Exception):
    """Something of the previous frame was asked for, and there is none."""


def fail(key, message):
    raise MappingError(f"{key}: {message}")


def load(path):
    def no_twice(pairs):
        seen = dict(pairs)
        if len(seen) != len(pairs):
            twice = next(k for i, (k, _) in enumerate(pairs) if k in [p[0] for p in pairs[:i]])
            raise MappingError(f"{path}: the key {twice} stands twice")
        return seen

    try:
        with open(path, encoding="utf-8") as text:
            mapping = json.load(text, object_pairs_hook=no_twice)
    except json.JSONDecodeError as error:
        raise MappingError(f"{path}:{error.lineno}: {error.msg}") from None
    except (OSError, UnicodeDecodeError) as error:
        raise MappingError(f"{path}: {error}") from None
    check(mapping)
    return mapping


def check_keys(key, value, known, one_of=()):
    if not isinstance(value, dict):
        fail(key, f"expected an object, found {json.dumps(value)[:40]}")
    for name in value:
        if name not in known:
            fail(f"{key}.{name}" if key else name, f"is not a key here{suggest(name, known)}; expected {', '.join(sorted(known))}")
    if one_of and sum(name in value for name in one_of) != 1:
        fail(key, f"expected one of {', '.join(one_of)}, found {', '.join(n for n in one_of if n in value) or 'none'}")


def check(mapping):
    """Everything of a mapping that can be said without a frame."""
    check_keys("", mapping, SECTIONS)
    if mapping.get("glint_mapping") != 1:
        fail("glint_mapping", f"expected 1, the version of mappings, found {json.dumps(mapping.get('glint_mapping'))}")
    for section in ("passes", "manifest"):
        if not isinstance(mapping.get(section), dict):
            fail(section, "expected an object, found none")
    passes = mapping["passes"]
    names = {}
    for section in ("images", "constants", "values", "textures"):
        for name, entry in mapping.get(section, {}).items():
            key = f"{section}.{name}"
            if not name.isidentifier() or name == "previous":
                fail(key, "expected a name of letters, digits and _, other than previous")
            if section != "textures" and names.setdefault(name, section) != section:
                fail(key, f"{names[name]} has this name, too")
            if section == "values":
                if not isinstance(entry, str):
                    fail(key, f"expected an expression, found {json.dumps(entry)[:40]}")
                continue
            check_keys(key, entry, {"images": IMAGE_KEYS, "constants": CONSTANT_KEYS, "textures": TEXTURE_KEYS}[section],
                       {"images": ("sampler", "output", "depth", "storage_image"), "textures": ("image", "expression")}.get(section, ()))
            if section in ("images", "constants") and entry.get("pass") not in passes:
                fail(f"{key}.pass", f"expected a pass of this mapping, found {entry.get('pass')}{suggest(str(entry.get('pass')), passes)}")
            if section == "constants" and "member" not in entry:
                fail(key, "expected member, the name of a constant, found none")
            if entry.get("frame", "current") not in ("current", "previous"):
                fail(f"{key}.frame", f"expected current or previous, found {entry['frame']}")
            if entry.get("rows", "top_first") not in ("top_first", "bottom_first"):
                fail(f"{key}.rows", f"expected top_first or bottom_first, found {entry['rows']}")
            if "image" in entry and section == "textures" and entry["image"] not in mapping.get("images", {}):
                fail(f"{key}.image", f"expected an image of this mapping, found {entry['image']}{suggest(entry['image'], mapping.get('images', {}))}")


class Frame:
    """One frame under a mapping; everything is read and computed once, when it is first asked for."""

    def __init__(self, mapping, source, previous=None):
        self.mapping, self.source, self.previous = mapping, source, previous
        self.found, self.cache, self.busy = {}, {}, []
        for name, rule in mapping["passes"].items():
            try:
                self.found[name] = find.find(source.passes, rule, self.found)
            except find.FindError as error:
                fail(f"passes.{name}" + (f".{error.key}" if error.key else ""), error)

    def texture_of(self, name):
        """(event, texture) of an image."""
        entry = self.mapping["images"][name]
        key, where = f"images.{name}", self.found[entry["pass"]]
        if "sampler" in entry or "storage_image" in entry:
            word = "sampler" if "sampler" in entry else "storage_image"
            bound = find.samplers_of(where)
            if entry[word] not in bound:
                fail(f"{key}.{word}", f"{find.place(where)} reads no {entry[word]}{suggest(entry[word], bound)}; it reads {', '.join(sorted(bound)) or 'nothing'}")
            texture = bound[entry[word]]
        elif "output" in entry:
            outputs = where["outputs"]
            if not isinstance(entry["output"], int) or not 0 <= entry["output"] < len(outputs):
                fail(f"{key}.output", f"expected 0 to {len(outputs) - 1}, the outputs of {find.place(where)}, found {entry['output']}")
            texture = outputs[entry["output"]]
        else:
            texture = where["depth"]
        if texture is None:
            fail(key, f"nothing is bound there in {find.place(where)}")
        return where["last_event"], texture

    def rows(self, name, texture):
        """OpenGL has the bottom row of a picture first; cube faces are stored as every API has them."""
        said = self.mapping["images"][name].get("rows")
        return said or ("bottom_first" if self.source.api == "OpenGL" and not texture["cube"] else "top_first")

    def raw(self, name):
        """Bytes of an image, its texture, width and height."""
        event, texture = self.texture_of(name)
        entry = self.mapping["images"][name]
        mip = entry.get("mip", texture.get("mip", 0))
        if not 0 <= mip < texture["mips"]:
            fail(f"images.{name}.mip", f"expected 0 to {texture['mips'] - 1}, found {mip}")
        layers = range(6) if texture["cube"] and "layer" not in entry else [entry.get("layer", texture.get("slice", 0))]
        parts = [self.source.read(event, texture["id"], mip, layer) for layer in layers]
        return [p[0] for p in parts], texture, parts[0][1], parts[0][2]

    def image(self, name):
        parts, texture, width, height = self.raw(name)
        try:
            arrays = [texels.decode(p, texture["format"], width, height, self.source.api) for p in parts]
        except texels.FormatError as error:
            fail(f"images.{name}", error)
        if self.rows(name, texture) == "bottom_first":
            arrays = [a[::-1] for a in arrays]
        return np.stack(arrays) if len(arrays) > 1 else arrays[0]

    def constant(self, name):
        entry = self.mapping["constants"][name]
        try:
            member = find.constant(self.found[entry["pass"]], entry.get("block"), entry["member"])
        except find.FindError as error:
            fail(f"constants.{name}.{error.key}", error)
        value = np.array(member["value"], float)
        if member["rows"] > 1:
            return value.reshape(member["rows"], member["columns"])
        return value if member["columns"] > 1 else value[0]

    def look_up(self, name, frame="current"):
        if frame == "previous":
            if self.previous is None:
                raise NeedsPrevious()
            return self.previous.look_up(name)
        if name in self.cache:
            return self.cache[name]
        if name in self.busy:
            raise ExpressionError(f"{name} is computed from itself: {' -> '.join([*self.busy, name])}")
        self.busy.append(name)
        try:
            if name in self.mapping.get("images", {}):
                value = self.image(name)
            elif name in self.mapping.get("constants", {}):
                value = self.constant(name)
            elif name in self.mapping.get("values", {}):
                value = self.compute(f"values.{name}", self.mapping["values"][name])
            else:
                known = {n for s in ("images", "constants", "values") for n in self.mapping.get(s, {})}
                raise ExpressionError(f"{name} is no image, constant or value of this mapping{suggest(name, known)}")
        finally:
            self.busy.pop()
        self.cache[name] = value
        return value

    def compute(self, key, text):
        try:
            return Evaluator(self.look_up).evaluate(text)
        except ExpressionError as error:
            fail(key, error)


def write_texture(frame, name, folder):
    """Writes a texture of the mapping to a file; its entry in the manifest."""
    entry = frame.mapping["textures"][name]
    key = f"textures.{name}"
    if entry.get("frame") == "previous":
        if frame.previous is None:
            raise NeedsPrevious()
        frame = frame.previous
    if "image" in entry:
        parts, texture, width, height = frame.raw(entry["image"])
        try:
            form = texels.pack_name(texture["format"], frame.source.api)
        except texels.FormatError as error:
            fail(key, error)
        with open(os.path.join(folder, name + ".raw"), "wb") as file:
            file.writelines(parts)
        return {"file": name + ".raw", "format": form, "width": width, "height": height * len(parts), "rows": frame.rows(entry["image"], texture)}
    value = np.asarray(frame.compute(key, entry["expression"]))
    if value.ndim not in (3, 4):
        fail(key, f"expected an image, found {describe(value)}")
    value = value.astype(np.float32)
    bad = np.count_nonzero(np.isnan(value))
    if bad:
        fail(key, f"{bad} of {value.size} numbers are not a number; guard the expression with where or max")
    if value.ndim == 4:  # a strip of six faces below each other
        value = value.reshape(-1, *value.shape[2:])
    np.save(os.path.join(folder, name + ".npy"), value[..., 0] if value.shape[-1] == 1 else value)
    return {"file": name + ".npy"}


def uses(value, names):
    """Names of textures that a part of the manifest mentions."""
    if isinstance(value, dict):
        found = {value["texture"]} if isinstance(value.get("texture"), str) else set()
        return found.union(*(uses(v, names) for k, v in value.items() if k not in ("attributes", "comment")))
    if isinstance(value, str) and value.split(".")[0] in names:
        return {value.split(".")[0]}
    return set()


def fill(frame, key, value):
    """The manifest with each {"expression": …} replaced by its numbers."""
    if isinstance(value, dict):
        if set(value) == {"expression"}:
            result = np.asarray(frame.compute(key, value["expression"]), float)
            if result.ndim > 2:
                fail(key, f"expected numbers, found {describe(result)}")
            if not np.all(np.isfinite(result)):
                fail(key, "is not finite")
            return result.tolist() if result.ndim < 2 else result.reshape(-1).tolist()
        return {k: fill(frame, f"{key}.{k}", v) for k, v in value.items()}
    return value


def apply(mapping, source, folder, previous=None, say=lambda text: None):
    """Writes textures and manifest.json to the folder; what needs the previous frame is left out where there is none."""
    before = Frame(mapping, previous) if previous else None
    frame = Frame(mapping, source, before)
    os.makedirs(folder, exist_ok=True)
    for name, entry in frame.found.items():
        say(f"passes.{name}: {find.place(entry)}, {entry['draws']} draw{'s' if entry['draws'] != 1 else ''}")
    textures, left_out = {}, set()
    for name in mapping.get("textures", {}):
        try:
            textures[name] = write_texture(frame, name, folder)
        except NeedsPrevious:
            left_out.add(name)
    template = mapping["manifest"]
    manifest = {"glint": 1, "frame": {}, "textures": textures, "parts": {}}
    for section in ("frame", "parts"):
        for name, value in template.get(section, {}).items():
            key = f"manifest.{section}.{name}"
            if uses(value, left_out):
                say(f"{key}: left out, for there is no previous frame")
                continue
            try:
                manifest[section][name] = fill(frame, key, value)
            except NeedsPrevious:
                say(f"{key}: left out, for there is no previous frame")
    used = uses(manifest["parts"], set(textures))
    for name in sorted(set(textures) - used):
        say(f"textures.{name}: no part uses it")
        del textures[name]
    path = os.path.join(folder, "manifest.json")
    with open(path + ".new", "w", encoding="utf-8") as file:
        json.dump(manifest, file, indent=1)
        file.write("\n")
    os.replace(path + ".new", path)
    return path
