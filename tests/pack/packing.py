"""Runs glint pack on manifests that tests make, and reads what it wrote."""
import copy
import json
import os
import subprocess

SMALL = ("--size=24x16", "--cube-size=4", "--light=1", "--planar-size=12x8")


class Capture:
    """What tests/pack/decoded prints: matrices by name, parts by name, in them bytes of 32 bits a value by channel."""
    def __init__(self, decoded, path):
        run = subprocess.run([decoded, path], capture_output=True)
        assert run.returncode == 0, (path, run.stderr)
        self.frame, self.parts, self.sizes, self.storage, self.centers = {}, {}, {}, {}, {}
        data, at, part = run.stdout, 0, None
        while at < len(data):
            end = data.index(b"\n", at)
            words = data[at:end].decode().split(" ")
            at = end + 1
            if words[0] == "part":
                part = words[1]
                self.parts[part], self.storage[part] = {}, {}
                self.sizes[part] = int(words[2]), int(words[3])
            elif words[0] == "center":
                self.centers[part] = [float(word) for word in words[1:]]
            elif words[0] == "channel":
                size = 4 * self.sizes[part][0] * self.sizes[part][1]
                self.parts[part][words[1]] = data[at:at + size]
                self.storage[part][words[1]] = words[3]
                at += size
            else:
                self.frame[words[0]] = [float(word) for word in words[1:]]


class Base:
    """A sample scene, extracted: manifests of tests change its manifest."""
    def __init__(self, glint, folder, scene, *options):
        self.glint, self.folder = glint, folder
        self.capture = os.path.join(folder, scene + ".exr")
        self.run("sample", scene, "-o", self.capture, *SMALL, *options)
        self.run("extract", self.capture, "-o", folder)
        with open(os.path.join(folder, "manifest.json"), encoding="utf-8") as file:
            self.manifest = json.load(file)

    def run(self, *words, status=0):
        run = subprocess.run([self.glint, *words], capture_output=True, text=True)
        assert run.returncode == status, (words, run.returncode, run.stdout[-1500:], run.stderr[-700:])
        return run.stdout + run.stderr

    def write(self, name, manifest):
        path = os.path.join(self.folder, name + ".json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(manifest, file, indent=1)
        return path

    def changed(self, frame, textures, parts):
        manifest = copy.deepcopy(self.manifest)
        manifest["frame"].update(frame)
        manifest["textures"].update(textures)
        manifest["parts"].update(parts)
        return manifest

    def pack(self, decoded, name, frame, textures, parts):
        path, out = self.write(name, self.changed(frame, textures, parts)), os.path.join(self.folder, name + ".exr")
        self.run("pack", path, "-o", out)
        return Capture(decoded, out)

    def explain(self, textures, parts, status=0, file=None):
        if file is not None:
            with open(os.path.join(self.folder, "x.raw"), "wb") as out:
                out.write(file)
        return self.run("pack", self.write("explained", self.changed({}, textures, parts)), "--explain", status=status)
