"""What `glint lint` says of usual mistakes, made on purpose in the dump of a real engine: mistakes.py GLINT DUMP. Prints the table
of docs/engines/renderdoc.md. DUMP is a folder that tools/renderdoc/dump.py wrote."""
import copy
import json
import os
import pathlib
import subprocess
import sys
import tempfile

TRANSPOSED = ("world_to_view", "view_to_clip", "previous_world_to_view", "previous_view_to_clip")


def frame(**keys):
    return lambda m: m["frame"].update(keys)


def encoding(part, **keys):
    return lambda m: m["parts"][part].setdefault("encodings", {}).update(keys)


def channel(part, name, value):
    return lambda m: m["parts"][part].update({name: value})


def texture(name, **keys):
    return lambda m: m["textures"][name].update(keys)


def sign(axis):
    def change(m):
        del m["parts"]["gbuffer"]["normal"]
        for letter, component in zip("XYZ", "rgb"):
            m["parts"]["gbuffer"][f"normal.{letter}"] = {"texture": "normal", "channel": component, "scale": -1 if letter == axis else 1}
    return change


def swap(a, b):
    def change(m):
        m["textures"][a], m["textures"][b] = m["textures"][b], m["textures"][a]
    return change


def same_previous(m):
    m["frame"].update(previous_world_to_view=m["frame"]["world_to_view"], previous_view_to_clip=m["frame"]["view_to_clip"])


def other_previous(m):
    """The camera that moves the other way: as far from this frame as the previous one is, on the other side."""
    now, then = m["frame"]["world_to_view"], m["frame"]["previous_world_to_view"]
    m["frame"]["previous_world_to_view"] = then[:3] + [2 * now[3] - then[3]] + then[4:7] + [2 * now[7] - then[7]] + then[8:11] + [2 * now[11] - then[11]] + then[12:]


def view_flipped(m):
    """A camera that looks along -z, while the projection is for +z."""
    m["frame"]["world_to_view"] = [-v if i // 4 == 2 else v for i, v in enumerate(m["frame"]["world_to_view"])]


MISTAKES = (
    ("none", lambda m: None),
    ("the range of clip z is that of Direct3D", frame(clip_z="zero_to_one")),
    ("y of NDC points down", frame(clip_y="down")),
    ("the matrices are transposed", frame(layout="column_major")),
    ("the matrices are for row vectors", frame(vectors="row")),
    ("the view looks the other way", view_flipped),
    ("the jitter is half a pixel, and is none", frame(jitter=[0.5, 0.5], jitter_in_matrix=False)),
    ("normals in view space are declared as world space", encoding("gbuffer", normal_space="world")),
    ("x of the normals has the wrong sign", sign("X")),
    ("y of the normals has the wrong sign", sign("Y")),
    ("z of the normals has the wrong sign", sign("Z")),
    ("the depth's bottom row is on top", texture("depth", rows="top_first")),
    ("the normals' bottom row is on top", texture("normal", rows="bottom_first")),
    ("the depth is read as view-linear", encoding("gbuffer", depth="view_linear")),
    ("depth and stencil in the other order", texture("depth", format="VK_FORMAT_D24_UNORM_S8_UINT")),
    ("the depth is the previous frame's", swap("depth", "depth_before")),
    ("the light is the previous frame's", swap("light", "light_before")),
    ("the previous camera is this frame's", same_previous),
    ("the previous camera is the next frame's", other_previous),
    ("the light is linear, and is declared as sRGB", encoding("lit", color="srgb")),
    ("the light is the finished picture, with highlights", channel("lit", "RGB", "scene.rgb")),
    ("the roughness is declared as perceptual", lambda m: (channel("gbuffer", "material.roughness", {"texture": "power", "scale": 1 / 2048})(m), encoding("gbuffer", roughness="perceptual")(m))),
    ("the sky's faces are mirrored", texture("sky", cube={"mirror": True})),
    ("metres are taken for centimetres", frame(metres_per_unit=0.01)),
)


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
    os.unlink(capture)
    findings = json.loads(run.stdout)["findings"]
    return "lint: " + "; ".join(f"`{f['id']}` ({f['likelihood']})" for f in findings) if findings else "nothing"


def main():
    glint, dump = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    original = json.loads((dump / "manifest.json").read_text())
    for entry in original["textures"].values():
        entry["file"] = str(dump / entry["file"])
    print("| mistake | what is said |\n| --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for name, change in MISTAKES:
            manifest = copy.deepcopy(original)
            change(manifest)
            print(f"| {name} | {said(glint, manifest, pathlib.Path(folder))} |", flush=True)


if __name__ == "__main__":
    main()
