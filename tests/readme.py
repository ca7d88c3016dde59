"""Runs every command of README.md as it is printed, in order, in a folder of its own: readme.py GLINT [README] [FOLDER].

Command blocks are indented by four spaces; lines of them that begin with "glint " or "$ glint " are commands, and what follows a # is a
remark. `./dev readme` calls this."""
import json
import os
import shlex
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def commands(text):
    for line in text.splitlines():
        if line.startswith("    "):
            line = line[4:].removeprefix("$ ").split("  #")[0].split(" # ")[0].strip()
            if line.startswith("glint "):
                yield line


def box(low, high):
    """Corners and outward normals of a box, four to a side; and triangles."""
    corners, normals, triangles = [], [], []
    for axis in range(3):
        for side in (0, 1):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            if not side:
                u, v = v, u
            first = len(corners)
            for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                corner = [0, 0, 0]
                corner[axis] = (low, high)[side][axis]
                corner[u], corner[v] = (low, high)[a][u], (low, high)[b][v]
                corners.append(corner)
                normals.append([(2 * side - 1) * (k == axis) for k in range(3)])
            triangles += [first, first + 1, first + 2, first, first + 2, first + 3]
    return corners, normals, triangles


def write_scene(path):
    """A floor that mirrors, walls and crates of several colours, a camera: what a small scene exported from an editor holds."""
    parts = [((-6, -0.2, -6), (6, 0, 6), (0.3, 0.3, 0.32), 0.15, 0), ((-6, 0, -6.2), (6, 4, -6), (0.7, 0.25, 0.2), 0.6, 0),
             ((-6.2, 0, -6), (-6, 4, 6), (0.2, 0.5, 0.3), 0.6, 0), ((6, 0, -6), (6.2, 4, 6), (0.3, 0.35, 0.7), 0.6, 0),
             ((-2.5, 0, -3), (-1, 1.5, -1.5), (0.9, 0.75, 0.3), 0.3, 1), ((0.5, 0, -2), (1.7, 1.2, -0.8), (0.85, 0.85, 0.85), 0.4, 0),
             ((2.6, 0, -4), (3.6, 2.6, -3), (0.8, 0.3, 0.6), 0.2, 0)]
    binary, views, accessors, meshes, materials, nodes = b"", [], [], [], [], []

    def add(data, kind, component, count, **more):
        nonlocal binary
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": count, "type": kind, **more})
        binary += data
        return len(accessors) - 1

    for k, (low, high, color, roughness, metalness) in enumerate(parts):
        corners, normals, triangles = box(low, high)
        position = add(struct.pack(f"<{3 * len(corners)}f", *sum(corners, [])), "VEC3", 5126, len(corners), min=list(low), max=list(high))
        normal = add(struct.pack(f"<{3 * len(normals)}f", *sum(normals, [])), "VEC3", 5126, len(normals))
        index = add(struct.pack(f"<{len(triangles)}I", *triangles), "SCALAR", 5125, len(triangles))
        materials.append({"pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": metalness, "roughnessFactor": roughness}})
        meshes.append({"primitives": [{"attributes": {"POSITION": position, "NORMAL": normal}, "indices": index, "material": k}]})
        nodes.append({"mesh": k})
    nodes.append({"camera": 0, "translation": [0, 1.6, 5], "rotation": [-0.07, 0, 0, 0.9975]})
    scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes, "meshes": meshes,
             "materials": materials, "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(binary)}],
             "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "aspectRatio": 16 / 9, "znear": 0.1}}]}
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)) + struct.pack("<I4s", len(text), b"JSON") + text +
                   struct.pack("<I4s", len(binary), b"BIN\0") + binary)


def prepare(folder, glint):
    """What a reader has: a scene; a copy of a shader; an engine's capture whose normals are in view space, which nothing in it says."""
    write_scene(os.path.join(folder, "scene.glb"))
    shutil.copy(os.path.join(ROOT, "passes/resolve/hit.comp"), os.path.join(folder, "my_resolve.comp"))
    frame = os.path.join(folder, "frame.exr")
    subprocess.run([glint, "sample", "street", "-o", frame, "--size=240x135", "--cube-size=64", "--encoding=normal_space=view"], check=True, capture_output=True)
    with open(frame, "rb") as file:
        data = file.read()
    assert b"glint.normalSpace\0" in data
    with open(frame, "wb") as file:
        file.write(data.replace(b"glint.normalSpace\0", b"glint.normalSpacE\0"))


def run(line, folder, path):
    """Whether it did what a reader expects: comparisons may say that things differ, and whoever watches presses Ctrl-C."""
    start = time.monotonic()
    words = shlex.split(line)
    allowed = (0, 1, 2) if words[1] in ("diff", "check", "lint") else (0,)
    process = subprocess.Popen(words if "*" not in line else ["bash", "-c", line], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                               env={**os.environ, "PATH": f"{path}:{os.environ['PATH']}"})
    said = []
    for text in process.stdout:
        said.append(text)
        if "--watch" in words and "Ctrl-C" in text:
            process.send_signal(signal.SIGINT)
    ok = process.wait() in allowed
    print(f"{'ok    ' if ok else 'FAILED'} {time.monotonic() - start:7.1f} s  {line}" + ("" if ok else "\n" + "".join(said)[-1500:]), flush=True)
    return ok


def main():
    glint = os.path.abspath(sys.argv[1])
    readme = sys.argv[2] if len(sys.argv) > 2 else os.path.join(ROOT, "README.md")
    with open(readme, encoding="utf-8") as file:
        lines = list(commands(file.read()))
    with tempfile.TemporaryDirectory() as temporary:
        folder = os.path.abspath(sys.argv[3]) if len(sys.argv) > 3 else temporary
        os.makedirs(folder, exist_ok=True)
        prepare(folder, glint)
        failed = [line for line in lines if not run(line, folder, os.path.dirname(glint))]
    print(f"{len(lines) - len(failed)} of {len(lines)} commands of README.md did what they are printed for")
    return len(failed) > 0


if __name__ == "__main__":
    sys.exit(main())
