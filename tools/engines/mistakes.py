"""Usual mistakes of an integration, made on purpose in the dump of a real engine: what pack, validate and lint say of each, and what it looks like.
Run by ./dev engines renderdoc; mistakes.py GLINT DUMP FOLDER [--page MD] [--sheet JPG]. DUMP is a folder that tools/renderdoc/dump.py wrote of SuperTuxKart;
FOLDER keeps the results. --page writes the table between its marks in a page."""
import argparse
import json
import pathlib
import re
import subprocess

import numpy as np

import mistake_sheet


def frame(**keys):
    return lambda m, _: m["frame"].update(keys)


def encoding(part, **keys):
    return lambda m, _: m["parts"][part].setdefault("encodings", {}).update(keys)


def channel(part, name, value):
    return lambda m, _: m["parts"][part].update({name: value})


def texture(name, **keys):
    return lambda m, _: m["textures"][name].update(keys)


def flipped(axis):
    """The other sign of x or y of the normals, whose codes are (e + 1) / 2 along them."""
    def change(m, _):
        del m["parts"]["gbuffer"]["normal"]
        for letter, component in zip("XY", "rg"):
            turned = {"scale": -1, "offset": 1} if letter == axis else {}
            m["parts"]["gbuffer"][f"normal.{letter}"] = {"texture": "normal_code", "channel": component, **turned}
    return change


def normals_alone(**keys):
    """Keys of the texture for the normals; the material that it holds, too, is read as before."""
    def change(m, _):
        m["textures"]["normals_alone"] = {**m["textures"]["normal_code"], **keys}
        m["parts"]["gbuffer"]["normal"] = "normals_alone.rg"
    return change


def codes(m):
    """The spheremap's two codes in [-1, 1], rows as they are stored; texels of 8:8:8:8."""
    entry = m["textures"]["normal_code"]
    return np.fromfile(entry["file"], "u1").reshape(entry["height"], entry["width"], 4)[..., :2] / 127.5 - 1


def other_normals(work, **encodings):
    """Other numbers for the normals, made of their codes."""
    def change(m, folder):
        normals = np.asarray(work(codes(m)), "<f4")
        np.save(folder / "changed.npy", normals)
        normals_alone(file=str(folder / "changed.npy"))(m, folder)
        for key in ("format", "width", "height"):
            del m["textures"]["normals_alone"][key]
        m["parts"]["gbuffer"]["encodings"].update(encodings)
        m["parts"]["gbuffer"]["normal"] = "normals_alone." + "rgb"[:normals.shape[-1]]
    return change


def in_view_space(e):
    """Normals of codes; the view looks along +z."""
    z = 2 * np.sum(e * e, -1, keepdims=True) - 1
    n = np.concatenate([2 * e * np.sqrt(np.clip(1 - z, 0, 2) / 2), z], -1)
    return n / np.linalg.norm(n, axis=-1, keepdims=True)


def other_z(e):
    """Codes of the normal with the other sign of z: their length is the root of 1 less its square."""
    length = np.linalg.norm(e, axis=-1, keepdims=True)
    return (e * np.sqrt(np.clip(1 - length**2, 0, 1)) / np.maximum(length, 1e-6) + 1) / 2


def swap(a, b):
    def change(m, _):
        m["textures"][a], m["textures"][b] = m["textures"][b], m["textures"][a]
    return change


def both(*changes):
    def change(m, folder):
        for one in changes:
            one(m, folder)
    return change


def pixels(name, work):
    """Other numbers in a texture of floats."""
    def change(m, folder):
        np.save(folder / "changed.npy", np.asarray(work(np.load(m["textures"][name]["file"])), "<f4"))
        m["textures"][name]["file"] = str(folder / "changed.npy")
    return change


def to_srgb(v):
    return np.where(v <= 0.0031308, 12.92 * v, 1.055 * np.maximum(v, 1e-9) ** (1 / 2.4) - 0.055)


def dark_sky(m, folder):
    """Light from before the sky is drawn, where depth is 1; 24 bits above 8 of stencil."""
    depth = np.fromfile(m["textures"]["depth"]["file"], "<u4").reshape(m["textures"]["depth"]["height"], -1) >> 8
    sky = depth[::-1] if m["textures"]["depth"]["rows"] == "bottom_first" else depth
    pixels("light", lambda v: np.where((sky == 0xffffff)[..., None], 0, v))(m, folder)


def half_texel(v):
    return (v + np.roll(v, 1, axis=1)) / 2


def without(part):
    return lambda m, _: m["parts"].pop(part)


def same_previous(m, _):
    m["frame"].update(previous_world_to_view=m["frame"]["world_to_view"], previous_view_to_clip=m["frame"]["view_to_clip"])


def moved_previous(steps):
    """The previous camera as it would be that many frames before this one, at this speed."""
    def change(m, _):
        now, then = m["frame"]["world_to_view"], m["frame"]["previous_world_to_view"]
        m["frame"]["previous_world_to_view"] = [now[i] + steps * (then[i] - now[i]) if i in (3, 7, 11) else then[i] for i in range(16)]
    return change


def view_flipped(m, _):
    """A camera that looks along -z, while the projection is for +z."""
    m["frame"]["world_to_view"] = [-v if i // 4 == 2 else v for i, v in enumerate(m["frame"]["world_to_view"])]


# Name, change, and the preset whose reflection shows it: kf2 traces mirror rays through scene, mafia3 lobes through lit and the sky.
MISTAKES = (
    ("none", lambda m, _: None, "kf2"),
    ("the range of clip z is that of Direct3D", frame(clip_z="zero_to_one"), "kf2"),
    ("y of NDC points down", frame(clip_y="down"), "kf2"),
    ("the matrices are transposed", frame(layout="column_major"), "kf2"),
    ("the matrices are for row vectors", frame(vectors="row"), "kf2"),
    ("the view looks the other way", view_flipped, "kf2"),
    ("the jitter is half a pixel, and is none", frame(jitter=[0.5, 0.5], jitter_in_matrix=False), "kf2"),
    ("normals in view space are declared as world space", other_normals(in_view_space, normal="signed", normal_space="world"), "kf2"),
    ("the normals' codes are declared as octahedral", encoding("gbuffer", normal="octahedral"), "kf2"),
    ("x of the normals has the wrong sign", flipped("X"), "kf2"),
    ("y of the normals has the wrong sign", flipped("Y"), "kf2"),
    ("z of the normals has the wrong sign", other_normals(other_z), "kf2"),
    ("the depth's bottom row is on top", texture("depth", rows="top_first"), "kf2"),
    ("the normals' bottom row is on top", normals_alone(rows="top_first"), "kf2"),
    ("the light's bottom row is on top", texture("light", rows="bottom_first"), "mafia3"),
    ("the depth is read as view-linear", encoding("gbuffer", depth="view_linear"), "kf2"),
    ("depth and stencil in the other order", texture("depth", format="VK_FORMAT_D24_UNORM_S8_UINT"), "kf2"),
    ("the depth is the previous frame's", swap("depth", "depth_before"), "kf2"),
    ("the light is the previous frame's, and the reverse", swap("light", "light_before"), "mafia3"),
    ("the light is the previous frame's", channel("lit", "RGB", "light_before.rgb"), "mafia3"),
    ("the light is the previous frame's, which is not there", both(channel("lit", "RGB", "light_before.rgb"), without("previous.lit")), "mafia3"),
    ("the light has no sky", dark_sky, "mafia3"),
    ("the light is half a texel to the right", pixels("light", half_texel), "mafia3"),
    ("the normals are half a texel to the right", other_normals(lambda e: (half_texel(e) + 1) / 2), "kf2"),
    ("the previous camera is this frame's", same_previous, "kf2"),
    ("the previous camera is the next frame's", moved_previous(-1), "kf2"),
    ("the previous camera is that of two frames ago", moved_previous(2), "kf2"),
    ("the light is linear, and is declared as sRGB", encoding("lit", color="srgb"), "mafia3"),
    ("the light is sRGB, and is read as linear", pixels("light", to_srgb), "mafia3"),
    ("red and blue of the light are swapped", channel("lit", "RGB", "light.bgr"), "mafia3"),
    ("the light is the finished picture, with highlights", channel("lit", "RGB", "scene.rgb"), "mafia3"),
    ("the roughness is declared as perceptual", encoding("gbuffer", roughness="perceptual"), "mafia3"),
    ("the sky is linear, and is declared as sRGB", encoding("sky", color="srgb"), "mafia3"),
    ("the sky's faces are mirrored", texture("sky", cube={"mirror": True}), "mafia3"),
    ("the sky's faces stand on their heads", texture("sky", rows="bottom_first"), "mafia3"),
    ("the sky is looked up with z up", texture("sky", cube={"axes": ["+x", "-z", "+y"]}), "mafia3"),
    ("metres are taken for centimetres", frame(metres_per_unit=0.01), "mafia3"),
)
# What data cannot tell, and why.
REASONS = {
    "the light is the previous frame's, which is not there": "without `previous.lit`, nothing tells which frame a light is of",
    "the light is half a texel to the right": "light and G-buffer are compared as colours along rays and across frames, to more than half a texel",
    "the normals are half a texel to the right": "half a texel is less than what a normal map does to a normal",
    "the roughness is declared as perceptual": "no other image depends on the roughness",
    "metres are taken for centimetres": "all lengths are in the same unit",
}


def said(glint, manifest, folder):
    """What pack, validate or lint says first, without the names of files."""
    path, capture = folder / "mistaken.json", folder / "mistaken.exr"
    path.write_text(json.dumps(manifest))
    run = subprocess.run([glint, "pack", path, "-o", capture], capture_output=True, text=True)
    if run.returncode:
        return "pack: " + run.stderr.strip().split("\n")[-1].removeprefix("glint pack: ").removeprefix(f"{path}:").split(": ", 1)[-1]
    run = subprocess.run([glint, "validate", capture], capture_output=True, text=True)
    if run.returncode:
        return "validate: " + run.stdout.strip().split("\n")[0].replace(f"{capture}: ", "")
    run = subprocess.run([glint, "lint", capture, "--json"], capture_output=True, text=True)
    findings = json.loads(run.stdout)["findings"]
    return "lint: " + "; ".join(f"`{f['id']}` ({f['likelihood']}{', or: ' + f['or'] if 'or' in f else ''})" for f in findings) if findings else "nothing"


def original(dump):
    manifest = json.loads((dump / "manifest.json").read_text())
    manifest["frame"]["material"].pop("roughest_reflection", None)  # the road's roughness: it would reflect nothing, and show no mistake
    for entry in manifest["textures"].values():
        entry["file"] = str(dump / entry["file"])
    return manifest


def table(results):
    """The rows of the page, the sum of them, and why data cannot tell the silent ones."""
    rows = ["| | mistake | what is said |", "| --- | --- | --- |"]
    for number, (name, _, _) in enumerate(MISTAKES):
        rows.append(f"| {number or ''} | {name} | {results[name]}" + (f": {REASONS[name]}" if results[name] == "nothing" and name in REASONS else "") + " |")
    told = sum(results[name] != "nothing" for name, _, _ in MISTAKES[1:])
    return "\n".join(rows) + f"\n\nOf {len(MISTAKES) - 1} mistakes {told} are told."


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("glint", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("dump", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("folder", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("--page", type=pathlib.Path)
    parser.add_argument("--sheet", type=pathlib.Path)
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    results = {}
    for number, (name, change, preset) in enumerate(MISTAKES):
        manifest = original(arguments.dump)
        change(manifest, arguments.folder)
        results[name] = said(arguments.glint, manifest, arguments.folder)
        print(f"{name}: {results[name]}", flush=True)
        for shown in ("kf2", "mafia3") if number == 0 else (preset,):
            if arguments.sheet and not results[name].startswith("pack: "):
                mistake_sheet.take(arguments.glint, arguments.folder, number, shown)
    (arguments.folder / "mistakes.json").write_text(json.dumps(results, indent=1) + "\n")
    if arguments.page:
        text = arguments.page.read_text()
        arguments.page.write_text(re.sub(r"(<!-- table mistakes -->\n).*?(<!-- end -->)", lambda m: m[1] + table(results) + "\n" + m[2], text, flags=re.S))
    if arguments.sheet:
        mistake_sheet.lay_out(arguments.folder, [(number, preset) for number, (_, _, preset) in enumerate(MISTAKES)], arguments.sheet)


if __name__ == "__main__":
    main()
