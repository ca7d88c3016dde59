"""Cube maps as pictures: what a camera sees from the centre, by its forward and up vectors, and how six pictures lie in a texture. Derived from
cameras, where pack's own table is one of formulas."""
import itertools

AXES = {"+x": (1, 0, 0), "-x": (-1, 0, 0), "+y": (0, 1, 0), "-y": (0, -1, 0), "+z": (0, 0, 1), "-z": (0, 0, -1)}
FACES = list(AXES)
# In a left-handed world the APIs' faces are upright pictures: leaning back from +Z to see +Y puts -Z at the top, bowing to -Y puts +Z there.
UP = {"+x": (0, 1, 0), "-x": (0, 1, 0), "+y": (0, 0, -1), "-y": (0, 0, 1), "+z": (0, 1, 0), "-z": (0, 1, 0)}


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def picture(face, n):
    """Directions (scaled by n, whole numbers) that the texels of the API's face show, rows from the top."""
    forward, up = AXES[face], UP[face]
    right = cross(up, forward)  # left-handed
    return [[tuple(n * f + (2 * i + 1 - n) * r - (2 * j + 1 - n) * u for f, r, u in zip(forward, right, up)) for i in range(n)] for j in range(n)]


def flipped(rows):
    return rows[::-1]


def mirrored(rows):
    return [row[::-1] for row in rows]


def turned(rows, quarters):
    """Clockwise."""
    for _ in range(quarters):
        rows = [list(row) for row in zip(*rows[::-1])]
    return rows


def world_of(vector, axes):
    """The direction in the world whose looked-up vector is `vector`: its component k is the world's axis axes[k]."""
    world = [0, 0, 0]
    for component, axis in zip(vector, axes):
        for k in range(3):
            world[k] += component * AXES[axis][k]
    return tuple(world)


def arrange(rng, n):
    """A random arrangement: the manifest's words, `cube` and `rows`, and for each image the grid of the world's directions that it shows (None where
    nothing lies), layers as a list of grids."""
    layout = rng.choice(["strip_vertical", "strip_horizontal", "cross_vertical", "cross_horizontal", "layers", "files"])
    order, axes = rng.sample(FACES, 6), [rng.choice("+-") + letter for letter in rng.sample("xyz", 3)]
    mirror, turn, bottom = rng.random() < 0.5, [rng.randrange(4) for _ in FACES], rng.random() < 0.5
    crossed = layout.startswith("cross")
    stored = {}
    for k, face in enumerate(FACES):
        rows = [[world_of(d, axes) for d in row] for row in picture(face, n)]
        rows = turned(rows, -turn[k] % 4)
        rows = mirrored(rows) if mirror else rows
        stored[face] = flipped(rows) if bottom and not crossed else rows
    words = {"order": order, "axes": axes, "mirror": mirror, "turn": turn}
    if layout != "files" and (crossed or layout == "layers" or rng.random() < 0.5):
        words["layout"] = layout
    if layout in ("layers", "files"):
        return layout, words, bottom, [stored[face] for face in order]
    if layout == "strip_vertical":
        return layout, words, bottom, [list(itertools.chain.from_iterable(stored[face] for face in order))]
    if layout == "strip_horizontal":
        return layout, words, bottom, [[list(itertools.chain.from_iterable(stored[face][j] for face in order)) for j in range(n)]]
    if layout == "cross_horizontal":
        plan = [[None, "+y", None, None], ["-x", "+z", "+x", "-z"], [None, "-y", None, None]]
    else:
        plan = [[None, "+y", None], ["-x", "+z", "+x"], [None, "-y", None], [None, "-z", None]]
        stored["-z"] = turned(stored["-z"], 2)
    empty = [[None] * n] * n
    grid = [list(itertools.chain.from_iterable((stored[face] if face else empty)[j] for face in line)) for line in plan for j in range(n)]
    del words["order"]
    return layout, words, bottom, [flipped(grid) if bottom else grid]
