"""The error of mirrors before and after temporal_sharp by how much of their history was hidden: hidden_history.py GLINT DIR [SCENE…]. Captures that
DIR holds already are kept."""
import glob
import os
import subprocess
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "python"))
import glint  # noqa: E402

FRAMES = 8
BINS = (("nothing", -1, 0), ("up to a tenth", 0, 0.1), ("a tenth to a half", 0.1, 0.5), ("more", 0.5, 2))


def error(found, truth):
    return (np.abs(found - truth) / (np.abs(found) + np.abs(truth) + 0.05)).mean(-1)


def runs_of(program, folder, scene, *options):
    shot = os.path.join(folder, scene)
    subprocess.run([program, "sample", scene, "-o", shot + ".exr", f"--frames={FRAMES}", "--size=320x180", "--cube-size=64", "--truth=16", "--light=8"], check=True)
    captures = sorted(glob.glob(shot + ".0*.exr"))
    run = shot + "-run" + "".join(options).replace(".", "-")
    subprocess.run([program, "replay", *captures, "-o", run, "--preset=mafia3", "--use=disocclusion=depth",
                    "--outputs=reflection_sharp,reflection_stable,disocclusion", *options], check=True)
    return [(each, os.path.join(run, os.path.basename(each)[: -len(".exr")])) for each in captures[1:]]  # the first frame has no history


def measure(program, folder, scene):
    errors = {name: [] for name, _, _ in BINS}
    for (capture, on), (_, off) in zip(runs_of(program, folder, scene), runs_of(program, folder, scene, "--set=temporal_sharp.uncovered=1.01")):
        parts, test, plain = glint.open(capture), glint.Run(on), glint.Run(off)
        surface, truth = parts["gbuffer"], parts["truth.reflection.ggx"]
        true = truth.read("R", "G", "B")
        smooth = (surface.read("material.roughness") <= 0.1) & (truth.read("weight") > 0)
        smooth &= (surface.read("material.specular") > 0) | (surface.read("material.metalness") > 0)
        hidden = np.squeeze(test["disocclusion"].read())
        images = [error(image.read()[..., :3], true) for image in (plain["reflection_sharp"], plain["reflection_stable"], test["reflection_stable"])]
        for name, above, most in BINS:
            chosen = smooth & (hidden > above) & (hidden <= most)
            errors[name].append(np.stack([image[chosen] for image in images]))
    for name, values in errors.items():
        values = np.concatenate(values, 1)
        print(scene, name, values.shape[1], "pixels: before {:.4f}, after without the test {:.4f}, with it {:.4f}".format(*values.mean(1)), flush=True)


if __name__ == "__main__":
    for each in sys.argv[3:] or ("room", "street", "hotel"):
        measure(sys.argv[1], sys.argv[2], each)
