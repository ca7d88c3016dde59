"""Where cube maps stand: probes of the scene, or places that are chosen by a rule."""
import bpy
import mathutils
import numpy as np

PREFIX = "glint_probe"  # of the names of empties
GRID = (10, 10, 5)
CLEARANCE = 0.3  # metres, the least distance from a candidate to any surface


def given(depsgraph):
    """Names and positions of light probes of the kind cube map, and of empties whose name begins with the prefix."""
    found = []
    for item in bpy.data.objects:
        cube = item.type == "LIGHT_PROBE" and item.data.type in ("CUBEMAP", "CUBE", "SPHERE")
        if cube or (item.type == "EMPTY" and item.name.startswith(PREFIX)):
            found.append((item.name, np.array(item.evaluated_get(depsgraph).matrix_world.translation, np.float64)))
    return sorted(found)


_DIRECTIONS = [mathutils.Vector(v).normalized() for v in np.ndindex(3, 3, 3) for v in [tuple(c - 1 for c in v)] if any(v)]


def _clearance(scene, depsgraph, position, most):
    """The distance to the nearest surface in 26 directions; 0 inside of something: where most rays meet the backs of faces."""
    nearest, backs, hits = most, 0, 0
    for direction in _DIRECTIONS:
        hit, end, normal, *_ = scene.ray_cast(depsgraph, position, direction, distance=most)
        if hit:
            hits += 1
            backs += normal.dot(direction) > 0
            nearest = min(nearest, (end - position).length)
    return 0 if 2 * backs > hits else nearest


def placed(scene, depsgraph, seen, eye, count, unit):
    """`count` positions for the surfaces that the camera sees (their positions in the world): candidates are a grid of 10 × 10 × 5 over
    the box that holds 96 % of them on each axis and the camera, at least 0.3 m away from every surface. The first one is the one nearest to the box's
    middle; then, one after the other, the one that is farthest from all that were chosen."""
    box = np.nanpercentile(seen.reshape(-1, 3), (2, 98), axis=0)
    low, high = np.minimum(box[0], eye), np.maximum(box[1], eye)
    axes = [low[i] + (high[i] - low[i]) * (np.arange(n) + 0.5) / n for i, n in enumerate(GRID)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    least = CLEARANCE / unit
    free = np.array([p for p in grid if _clearance(scene, depsgraph, mathutils.Vector(p), 2 * least) >= least])
    chosen = []
    while len(chosen) < count and len(free):
        distance = (-np.linalg.norm(free - (low + high) / 2, axis=1) if not chosen
                    else np.min([np.linalg.norm(free - c, axis=1) for c in chosen], axis=0))
        chosen.append(free[np.argmax(distance)])
    return [(f"placed {i}", position) for i, position in enumerate(chosen)]
