"""The figures of docs/engines/babylon.md, from the folder that babylon.py filled."""
import json

import numpy
import OpenImageIO


def image(path, part=None):
    """Channels of a part of an EXR file by their names, rows from the top."""
    source = OpenImageIO.ImageInput.open(str(path))
    if not source:
        raise SystemExit(f"babylon_figures.py: {path}: {OpenImageIO.geterror()}")
    index = 0
    while part and source.spec(index).getattribute("name") != part:
        index += 1
        if source.spec(index).width == 0:
            raise SystemExit(f"babylon_figures.py: {path}: no part {part}")
    spec = source.spec(index)
    pixels = source.read_image(index, 0, 0, spec.nchannels, OpenImageIO.FLOAT)
    source.close()
    return {name.split(".")[-1]: pixels[..., i] for i, name in enumerate(spec.channelnames)}


def color(channels):
    return numpy.stack([channels[c] for c in "RGB"], -1).astype(float)


def run_image(run, slot, name):
    path = next(run.glob(f"*-{slot}.exr"))
    return image(path, name)


def rms(difference):
    return float(numpy.sqrt(numpy.mean(numpy.square(difference)))) if difference.size else float("nan")


def ends(folder, run):
    """Where the engine's rays and a run's end: shares of the surfaces, and how far the colours are apart where both found one."""
    depth = image(folder / "frame.exr", "gbuffer")["Z"]
    theirs = color(image(folder / "frame.exr", "engine.resolve.reflection_half"))
    found = run_image(folder / run, "resolve", "reflection_half")
    ours, surface = color(found), numpy.isfinite(depth)
    here, there = (found["A"] > 0) & surface, (theirs.max(-1) > 0) & surface
    both, apart = here & there, numpy.abs(ours - theirs).max(-1)
    same = apart[both] <= 0.02 * theirs.max(-1)[both] + 1e-3
    count = surface.sum()
    return {"both": both.sum() / count, "engine_alone": (there & ~here).sum() / count, "glint_alone": (here & ~there).sum() / count,
            "neither": (surface & ~here & ~there).sum() / count, "same_color": same.mean(), "rms_both": rms((ours - theirs)[both]),
            "mean": float(theirs[both].mean())}


def final(folder, run):
    """RMS over red, green and blue of the whole picture: the blurred reflection, and the composed picture."""
    return {"reflection": rms(color(run_image(folder / run, "upscale", "reflection")) - color(image(folder / "frame.exr", "engine.upscale.reflection"))),
            "composed": rms(color(run_image(folder / run, "compose", "composed")) - color(image(folder / "frame.exr", "engine.compose.composed")))}


def same_picture(folder, other):
    """The same scene in another world: dumps and replays against the left-handed one."""
    def compare(a, b):
        apart = numpy.abs(a - b).max(-1)
        return {"rms": rms(a - b), "median": float(numpy.median(apart)), "within_1_percent": float((apart <= 0.01 * numpy.abs(a).max(-1) + 1e-3).mean())}
    left, right = folder / "left", folder / other
    return {"lit": compare(color(image(left / "frame.exr", "lit")), color(image(right / "frame.exr", "lit"))),
            "reflection": compare(color(run_image(left / "kf2", "upscale", "reflection")), color(run_image(right / "kf2", "upscale", "reflection"))),
            "composed": compare(color(run_image(left / "kf2", "compose", "composed")), color(run_image(right / "kf2", "compose", "composed"))),
            "engine": compare(color(image(left / "frame.exr", "engine.resolve.reflection_half")), color(image(right / "frame.exr", "engine.resolve.reflection_half")))}


def measure(folder):
    left = folder / "left"
    return {"ends": {run: ends(left, run) for run in ("like_babylon", "traced", "kf2")},
            "final": {run: final(left, run) for run in ("kf2", "mafia3")},
            "worlds": {world: same_picture(folder, world) for world in ("right", "left_reversed", "right_reversed")},
            "lint": {path.parent.name: path.read_text().strip().split(": ")[-1] for path in sorted(folder.glob("*/lint.txt"))},
            "seconds": {path.parent.name: json.loads(path.read_text()) for path in [folder / "times.json", *sorted(folder.glob("*/times.json"))]}}


def tables(figures):
    """As in docs/engines/babylon.md."""
    def percent(share, digits=1):
        return f"{100 * share:.{digits}f} %"
    lines = ["| run | both found a surface | Babylon.js alone | glint alone | neither | same colour where both | RMS where both |", "| --- | --- | --- | --- | --- | --- | --- |"]
    for run, f in figures["ends"].items():
        lines.append(f"| `{run}` | {percent(f['both'])} | {percent(f['engine_alone'])} | {percent(f['glint_alone'])} | {percent(f['neither'])} | "
                     f"{percent(f['same_color'])} | {f['rms_both']:.3f} (mean {f['mean']:.3f}) |")
    lines += ["", "| world | lit | kf2's reflection | kf2's picture | Babylon.js's own reflection |", "| --- | --- | --- | --- | --- |"]
    for world, f in figures["worlds"].items():
        cells = " | ".join(f"{f[k]['rms']:.2g}, {percent(f[k]['within_1_percent'], 3)}" for k in ("lit", "reflection", "composed", "engine"))
        lines.append(f"| {world.replace('_', ', ')} | {cells} |")
    lines += ["", *(f"{run}: RMS of the blurred reflection {f['reflection']:.3f}, of the picture {f['composed']:.3f}" for run, f in figures["final"].items()),
              *(f"lint, {world}: {said}" for world, said in figures["lint"].items())]
    return "\n".join(lines)
