"""Runs every command of README.md as it is printed, in order: readme.py GLINT.

Command blocks are indented by four spaces; what follows a # is a remark. `./dev` runs in the clone, all else in FOLDER, with the
program that `./dev install` has put there; lines under a command that begins with $ are what it prints. GLINT only makes the
files that a reader has before. After an interruption or a failure the next call continues, unless the tree has changed.

Prints each command's seconds beside those of the README, which are for two cores without a GPU: "(3 min)" in the remark, else a minute.
The seconds of the processors count where there are fewer of them: what else runs on a machine only lengthens the others.
`./dev readme` calls this."""
import hashlib
import json
import os
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FOLDER = os.path.join(ROOT, "build-release/readme")
LEFT = {"./dev test": "the suite runs by itself"}
# Exit statuses that report a finding, where the README states that there is one.
TELLING = {"diff": (0, 2), "lint": (0, 1)}
USUAL = 60  # seconds


def commands(text):
    """Each command, its output according to the README, and the seconds that it may take; None: the README does not say."""
    found = []
    for line in text.splitlines():
        if not line.startswith("    "):
            continue
        line = line[4:]
        bare, _, remark = re.sub(r" +# ", "  # ", line.removeprefix("$ ")).partition("  #")
        bare = bare.strip()
        if re.match(r"(glint|\./dev|cp) ", bare):
            says = re.search(r"\((\d+) min\)", remark)
            most = 60 * int(says[1]) if says else None if bare.startswith("./dev") else USUAL
            found.append((bare, [] if line.startswith("$ ") else None, most))
        elif found and found[-1][1] is not None:
            found[-1][1].append(line.rstrip())
    return found


def box(low, high):
    """Corners and outward normals of a box, four for each side; and triangles."""
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
    """A mirror-like floor, walls, coloured crates and a camera, like a small scene exported from an editor."""
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


def prepare(glint):
    """The files of a reader: a scene, a clone, and an engine's capture with undeclared view-space normals."""
    write_scene(os.path.join(FOLDER, "scene.glb"))
    os.symlink(os.path.join(ROOT, "passes"), os.path.join(FOLDER, "passes"))
    frame = os.path.join(FOLDER, "frame.exr")
    made = frame + ".made.exr"
    for words in (["sample", "street", "-o", made, "--size=240x135", "--cube-size=64", "--encoding=normal_space=view"],
                  ["set", made, "normalSpace=", "-o", frame]):
        subprocess.run([glint, *words], check=True, capture_output=True)
    os.remove(made)


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(line, prints, most):
    """The seconds, if the result is as expected: comparisons may report differences, and a watch or a server ends with Ctrl-C. Else None."""
    start, used = time.monotonic(), processor_seconds()
    words = line.split()
    prefix = os.path.join(FOLDER, "installed")
    process = subprocess.Popen(["bash", "-c", "exec " + line], cwd=ROOT if words[0] == "./dev" else FOLDER, text=True, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, env={**os.environ, "PREFIX": prefix, "PATH": f"{prefix}/bin:{os.environ['PATH']}"})
    said = []
    for text in process.stdout:
        said.append(text)
        if ("--watch" in words or words[1] == "live") and "Ctrl-C" in text:
            process.send_signal(signal.SIGINT)
    said = "".join(said)
    missing = [text for text in prints or [] if text not in said]
    ok = process.wait() in TELLING.get(words[1], (0,)) and not missing
    seconds, used = time.monotonic() - start, processor_seconds() - used
    late = ok and most is not None and min(seconds, used) > most
    why = "" if ok else f"\nexit {process.returncode}\n{said[-1500:]}" + "".join(f"\nnot printed: {text}" for text in missing)
    print(f"{'LONGER' if late else 'ok    ' if ok else 'FAILED'} {seconds:7.1f} s, {used:7.1f} s of the processors; README: "
          f"{most if most is not None else '–':>3} s  {line}{why}", flush=True)
    return seconds if ok and not late else None


def tree_key(lines):
    """A key of the tree and the machine: another tree begins again. A tree without git is taken to stay as it is."""
    parts = []
    if os.path.exists(os.path.join(ROOT, ".git")):
        parts = [subprocess.run(["git", *words], cwd=ROOT, check=True, capture_output=True).stdout for words in (("rev-parse", "HEAD"), ("diff", "HEAD"))]
    return hashlib.sha256(b"".join(parts) + json.dumps(lines).encode()).hexdigest()


class Record:
    """The commands that are done."""

    def __init__(self, key, make):
        self.path = os.path.join(FOLDER, "done.json")
        self.state = {"key": key, "done": {}}  # seconds by the number of the command
        try:
            with open(self.path, encoding="utf-8") as file:
                kept = json.load(file)
        except (OSError, ValueError):
            kept = {}
        if kept.get("key") == key:
            self.state = kept
            return
        shutil.rmtree(FOLDER, ignore_errors=True)
        os.makedirs(FOLDER)
        make()
        self.write()

    def write(self):
        with open(self.path + ".new", "w", encoding="utf-8") as file:
            json.dump(self.state, file)
        os.rename(self.path + ".new", self.path)

    def add(self, i, seconds):
        self.state["done"][str(i)] = seconds
        self.write()


def main():
    glint = os.path.abspath(sys.argv[1])
    with open(os.path.join(ROOT, "README.md"), encoding="utf-8") as file:
        lines = commands(file.read())
    record = Record(tree_key(lines), lambda: prepare(glint))
    failed = 0
    for i, (line, prints, most) in enumerate(lines):
        if line in LEFT:
            print(f"left             {line}: {LEFT[line]}")
        elif str(i) in record.state["done"]:
            print(f"before {record.state['done'][str(i)]:7.1f} s  {line}")
        elif (seconds := run(line, prints, most)) is not None:
            record.add(i, seconds)
        else:
            failed += 1
    print(f"{failed} of {len(lines)} commands of README.md failed, or took longer than it says" if failed else
          f"{len(lines)} commands of README.md did what they are printed for, in the time that it says")
    if not failed:
        os.remove(record.path)
    return failed > 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit("interrupted; the next call goes on from here")
