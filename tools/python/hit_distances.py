#!/usr/bin/python3
"""Draws how far the rays of a run travelled, by why they ended: hit_distances.py RUN -o PICTURE.png|.svg

RUN is a folder that `glint replay --diagnostics` wrote. An example of the package glint beside this file; it needs matplotlib."""
import argparse
import os
import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

import glint

BINS = 60
NEAREST_M = 0.01


class Group:
    """The rays that ended in one way, in one pass."""

    def __init__(self, label: str, distances_m: NDArray[np.float32]) -> None:
        self.label = label
        self.finite_m = distances_m[np.isfinite(distances_m)]
        self.infinite = len(distances_m) - len(self.finite_m)
        self.count = len(distances_m)


def groups(run: glint.Run) -> list[Group]:
    """All rays of the run, the largest group first. A ray that one pass leaves to the next counts in the one that traced it last."""
    tracers = []
    for done in run.passes:
        reasons = [image for image in done.images if image.unit == "end reason"]
        distances = [image for image in done.images if image.unit == "m"]
        if reasons and distances:
            tracers.append((done.slot, reasons[0].read(), distances[0].read()))
    if not tracers:
        raise glint.Error("usage", f"{run.folder}: expected images of end reasons, found none: replay with --diagnostics")
    found, later = [], np.zeros(tracers[0][1].shape, bool)
    for slot, reason, distance in reversed(tracers):
        own = np.where(later, 0, reason)  # 0: no ray in this pass
        later |= reason != 0
        for value in np.unique(own[own != 0]):
            text = run.end_reasons[value] if value < len(run.end_reasons) else f"end reason {value}"
            found.append(Group(f"{slot}: {text}", distance[own == value]))
    return sorted(found, key=lambda group: -group.count)


def draw(run: glint.Run) -> Any:
    """The matplotlib figure. Bars on a logarithmic scale; what is nearer than NEAREST_M, and what has no distance, stands apart."""
    import matplotlib.figure  # takes a second, which an error should not

    matplotlib.rcParams["svg.hashsalt"] = "glint"  # the same run gives the same file
    rays = groups(run)
    total = sum(group.count for group in rays)
    farthest_m = max((group.finite_m.max() for group in rays if len(group.finite_m)), default=0.0)
    edges = np.geomspace(NEAREST_M, max(farthest_m, 10 * NEAREST_M), BINS + 1)
    ratio = edges[1] / edges[0]
    counted = np.concatenate([[-np.inf], edges[:-1], [np.inf]])
    lefts = np.concatenate([[edges[0] / ratio ** 4], edges[:-1], [edges[-1] * ratio ** 2]])
    widths = np.concatenate([[lefts[0] * (ratio ** 2 - 1)], np.diff(edges), [lefts[-1] * (ratio ** 2 - 1)]])
    figure = matplotlib.figure.Figure(figsize=(10, 6), layout="constrained")
    axes = figure.subplots()
    tops = np.zeros(BINS + 2)
    for i, group in enumerate(rays):
        heights = np.append(np.histogram(group.finite_m, counted)[0], group.infinite)
        axes.bar(lefts, heights, widths, tops, align="edge", color=f"C{i}", label=f"{group.label} ({group.count}, {100 * group.count / total:.1f} %)")
        tops += heights
    for end, text in ((0, f"< {100 * NEAREST_M:g} cm"), (-1, "infinite")):
        if tops[end] > 0:
            axes.text(lefts[end] * ratio, tops[end], text, ha="center", va="bottom", fontsize="small")
    axes.set(xscale="log", ylim=(0, 1.08 * max(tops.max(), 1)), xlabel="distance travelled from the surface, m", ylabel="rays",
             title=f"{os.path.basename(os.path.normpath(run.folder))}: {total} rays of {run.json.get('preset') or 'a pipeline'}")
    axes.legend(fontsize="small", loc="upper center", bbox_to_anchor=(0.5, -0.12), ncol=2)
    return figure


def main() -> int:
    parser = argparse.ArgumentParser(description="Draw how far the rays of a run travelled, by why they ended.")
    parser.add_argument("run", metavar="RUN", help="folder that glint replay --diagnostics wrote")
    parser.add_argument("-o", "--output", required=True, metavar="PICTURE", help=".png or .svg")
    given = parser.parse_args()
    if not given.output.endswith((".png", ".svg")):
        parser.error(f"{given.output}: expected a name that ends in .png or .svg")
    try:
        draw(glint.Run(given.run)).savefig(given.output, dpi=120, metadata={"Date": None} if given.output.endswith(".svg") else None)
    except (glint.Error, OSError) as error:
        print(f"hit_distances.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
