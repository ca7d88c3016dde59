#!/usr/bin/env python3
"""SSIM, FLIP and HDR-FLIP by the papers' equations in double precision, two-dimensional convolutions written out, against the library.

    metrics.py COMPARE_RAW

Nothing is shared with the library: the matrices come from the primaries, the kernels are tables of all their taps.
"""
import array
import math
import operator
import os
import random
import subprocess
import sys
import tempfile


# ---- Images are lists of rows of (r, g, b), planes are lists of rows of numbers ----

def plane(width, height, value):
    return [[value(x, y) for x in range(width)] for y in range(height)]


def convolved(image, kernel):
    """`kernel` maps (dx, dy) to the weights of a square; the nearest pixel is repeated beyond edges."""
    height, width = len(image), len(image[0])
    radius = max(dx for dx, _ in kernel)
    reach = range(-radius, radius + 1)
    weights = [[kernel[dx, dy] for dx in reach] for dy in reach]
    wide = [row[:1] * radius + row + row[-1:] * radius for row in image]

    def at(x, y):
        rows = (wide[min(max(y + dy, 0), height - 1)][x:x + 2 * radius + 1] for dy in reach)
        return sum(sum(map(operator.mul, w, row)) for w, row in zip(weights, rows))
    return plane(width, height, at)


def zipped(function, *images):
    return [[function(*values) for values in zip(*rows)] for rows in zip(*images)]


def mean(values):
    values = list(values)
    return math.fsum(values) / len(values)


def flat(image):
    return [value for row in image for value in row]


# ---- Colors ----

def xyz_of_primary(x, y):
    return (x / y, 1.0, (1 - x - y) / y)


def determinant(m):
    (a, b, c), (d, e, f), (g, h, i) = m
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


def solve(m, v):
    """Cramer's rule."""
    whole = determinant(m)
    return [determinant([[v[r] if c == k else m[r][c] for c in range(3)] for r in range(3)]) / whole for k in range(3)]


WHITE = xyz_of_primary(0.31271, 0.32902)  # D65
PRIMARIES = [xyz_of_primary(0.64, 0.33), xyz_of_primary(0.30, 0.60), xyz_of_primary(0.15, 0.06)]
COLUMNS = [[p[r] for p in PRIMARIES] for r in range(3)]
SCALE = solve(COLUMNS, WHITE)
XYZ = [[COLUMNS[r][c] * SCALE[c] for c in range(3)] for r in range(3)]


def xyz(rgb):
    return [sum(XYZ[r][c] * rgb[c] for c in range(3)) for r in range(3)]


def ycxcz(color):
    x, y, z = (v / n for v, n in zip(color, WHITE))
    return (116 * y - 16, 500 * (x - y), 200 * (y - z))


def from_ycxcz(color):
    y = (color[0] + 16) / 116
    return [v * n for v, n in zip((color[1] / 500 + y, y, y - color[2] / 200), WHITE)]


def lab(color):
    def f(t):
        return t ** (1 / 3) if t > (6 / 29) ** 3 else t * (29 / 6) ** 2 / 3 + 4 / 29
    x, y, z = (f(v / n) for v, n in zip(color, WHITE))
    return (116 * y - 16, 500 * (x - y), 200 * (y - z))


def hunt(rgb):
    lightness, a, b = lab(xyz(rgb))
    return (lightness, 0.01 * lightness * a, 0.01 * lightness * b)


def hyab(p, q):
    return abs(p[0] - q[0]) + math.hypot(p[1] - q[1], p[2] - q[2])


def clipped(v):
    return min(max(v, 0.0), 1.0)


# ---- FLIP, 2020 ----

def sensitivity(ppd, parts):
    radius = math.ceil(3 * math.sqrt(0.04 / (2 * math.pi**2)) * ppd)
    kernel = {}
    for dx in range(-radius, radius + 1):
        for dy in range(-radius, radius + 1):
            square = (dx / ppd) ** 2 + (dy / ppd) ** 2
            kernel[dx, dy] = sum(a * math.sqrt(math.pi / b) * math.exp(-math.pi**2 * square / b) for a, b in parts)
    total = math.fsum(kernel.values())
    return {at: w / total for at, w in kernel.items()}


def derivative(ppd, order, across):
    sigma = 0.5 * 0.082 * ppd
    radius = math.ceil(3 * sigma)
    kernel = {}
    for dx in range(-radius, radius + 1):
        for dy in range(-radius, radius + 1):
            gauss, t = math.exp(-(dx * dx + dy * dy) / (2 * sigma**2)), dx if across else dy
            kernel[dx, dy] = -t * gauss if order == 1 else (t * t / sigma**2 - 1) * gauss
    up = math.fsum(w for w in kernel.values() if w > 0)
    down = -math.fsum(w for w in kernel.values() if w < 0)
    return {at: w / (up if w > 0 else down) for at, w in kernel.items()}


def features(image, ppd, order):
    gray = zipped(lambda c: (ycxcz(xyz(c))[0] + 16) / 116, image)
    return zipped(math.hypot, *(convolved(gray, derivative(ppd, order, across)) for across in (True, False)))


def seen(image, ppd):
    opponent = zipped(lambda c: ycxcz(xyz(c)), image)
    parts = [[(1, 0.0047)], [(1, 0.0053)], [(34.1, 0.04), (13.5, 0.025)]]
    filtered = [convolved(zipped(lambda c, k=k: c[k], opponent), sensitivity(ppd, parts[k])) for k in range(3)]
    back = zipped(lambda *c: [clipped(v) for v in solve(XYZ, from_ycxcz(c))], *filtered)
    return zipped(hunt, back)


def flip(found, truth, ppd):
    """For linear colours in [0, 1]."""
    largest = hyab(hunt((0, 1, 0)), hunt((0, 0, 1))) ** 0.7

    def color(p, q):
        difference = hyab(p, q) ** 0.7
        bend = 0.4 * largest
        return difference * 0.95 / bend if difference < bend else 0.95 + (difference - bend) / (largest - bend) * 0.05

    colors = zipped(color, seen(found, ppd), seen(truth, ppd))
    edges, points = (zipped(lambda a, b: abs(a - b), features(found, ppd, k), features(truth, ppd, k)) for k in (1, 2))
    feature = zipped(lambda e, p: (max(e, p) / math.sqrt(2)) ** 0.5, edges, points)
    return zipped(lambda c, f: c ** (1 - f), colors, feature)


# ---- HDR-FLIP, 2021 ----

def aces(x):
    x = 0.6 * max(x, 0.0)
    return clipped((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14))


def shown_as(level):
    """The radiance that the curve maps to `level`, by bisection."""
    low, high = 0.0, 100.0
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if aces(middle) < level else (low, middle)
    return low


def exposures(truth):
    bright = sorted(0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in flat(truth))
    middle = (bright[(len(bright) - 1) // 2] + bright[len(bright) // 2]) / 2
    start, stop = math.log2(shown_as(0.85) / bright[-1]), math.log2(shown_as(0.85) / middle)
    return start, stop, max(2, math.ceil(stop - start))


def hdr_flip(found, truth, ppd, start, stop, count):
    result = None
    for k in range(count):
        factor = 2 ** (start + (stop - start) * k / (count - 1))
        pair = [zipped(lambda c: tuple(aces(factor * v) for v in c), image) for image in (found, truth)]
        one = flip(*pair, ppd)
        result = one if result is None else zipped(max, result, one)
    return result


# ---- SSIM, 2004 ----

def ssim(found, truth, exposure):
    def shown(c):
        v = sum(w * aces(2**exposure * x) for w, x in zip((0.2126, 0.7152, 0.0722), c))
        return 12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055

    def window(image, x, y):
        return [image[y + dy][x + dx] for dy in range(-5, 6) for dx in range(-5, 6)]
    a, b = zipped(shown, found), zipped(shown, truth)
    weights = [math.exp(-(dx * dx + dy * dy) / (2 * 1.5**2)) for dy in range(-5, 6) for dx in range(-5, 6)]
    total = math.fsum(weights)
    weights = [w / total for w in weights]
    values = []
    for y in range(5, len(a) - 5):
        for x in range(5, len(a[0]) - 5):
            p, q = window(a, x, y), window(b, x, y)
            mp, mq = (math.fsum(w * v for w, v in zip(weights, s)) for s in (p, q))
            pp, qq, pq = (math.fsum(w * (u - mu) * (v - mv) for w, u, v in zip(weights, s, t))
                          for s, mu, t, mv in ((p, mp, p, mp), (q, mq, q, mq), (p, mp, q, mq)))
            values.append((2 * mp * mq + 1e-4) * (2 * pq + 9e-4) / ((mp**2 + mq**2 + 1e-4) * (pp + qq + 9e-4)))
    return mean(values) if values else math.nan


# ---- Pairs of images ----

def noisy(image, amount, seed):
    draw = random.Random(seed)
    return zipped(lambda c: tuple(v * (1 + amount * (2 * draw.random() - 1)) for v in c), image)


def pairs():
    draw = random.Random(1)
    edge = plane(17, 14, lambda x, y: (0.9, 0.8, 0.1) if x + y // 3 > 12 else (0.05, 0.1, 0.4))
    moved = plane(17, 14, lambda x, y: (0.9, 0.8, 0.1) if x + y // 3 > 13 else (0.05, 0.1, 0.4))
    ramp = plane(26, 17, lambda x, y: (x / 25, y / 16, 0.5 + 0.5 * math.sin(x * y / 20)))
    dots = plane(17, 21, lambda x, y: (1.0, 1.0, 1.0) if x % 6 == 2 and y % 7 == 3 else (0.02, 0.02, 0.02))
    wild = plane(19, 14, lambda x, y: (draw.uniform(-0.5, 2), draw.uniform(-0.5, 2), draw.uniform(-0.5, 2)))
    high = plane(18, 15, lambda x, y: tuple(k * 2 ** (9 * math.sin(x / 4) * math.cos(y / 5)) for k in (0.6, 0.3, 0.2)))
    green, blue = plane(5, 4, lambda x, y: (0, 1, 0)), plane(5, 4, lambda x, y: (0, 0, 1))
    single, other = [[(0.2, 0.5, 0.7)]], [[(0.3, 0.1, 0.9)]]
    line = plane(30, 1, lambda x, y: (x / 30, 0.3, 0.2))
    black = plane(16, 12, lambda x, y: (0.0, 0.0, 0.0) if x < 11 else (3.0 * y, 0.5, 0.1))
    return [("an edge that moved", moved, edge, 67.0206432766, 0),
            ("a ramp with noise", noisy(ramp, 0.2, 2), ramp, 33, 0),
            ("points that are missing", noisy(plane(17, 21, lambda x, y: (0.02, 0.02, 0.02)), 0.1, 3), dots, 40, 0),
            ("colors that no display has", noisy(wild, 0.9, 4), wild, 30, 0.5),
            ("eighteen f-stops", noisy(high, 0.5, 5), high, 20, 0),
            ("green for blue", green, blue, 67.0206432766, 0),
            ("one pixel", other, single, 67.0206432766, 1),
            ("one row", noisy(line, 0.3, 6), line, 50, 0),
            ("more than half is black", noisy(black, 0.4, 7), black, 20, 0)]


def library(tool, folder, found, truth, ppd, exposure, start=0.0, stop=0.0):
    paths = [os.path.join(folder, name) for name in ("found", "truth", "maps")]
    for path, image in zip(paths, (found, truth)):
        with open(path, "wb") as file:
            array.array("f", (v for c in flat(image) for v in c)).tofile(file)
    width, height = len(truth[0]), len(truth)
    out = subprocess.run([tool, str(width), str(height), *paths, repr(ppd), repr(exposure), repr(start), repr(stop)],
                         check=True, capture_output=True, text=True).stdout
    maps = array.array("f")
    with open(paths[2], "rb") as file:
        maps.fromfile(file, 2 * width * height)
    report = {name: float(value) for name, value in (line.split() for line in out.splitlines())}
    return report, maps[:width * height], maps[width * height:]


def rounded(image):
    """Rounds to floats, which the library reads."""
    return zipped(lambda c: tuple(array.array("f", c)), image)


class Checks:
    def __init__(self):
        self.lines, self.bad = [], 0

    def near(self, what, found, expected, tolerance):
        good = abs(found - expected) <= tolerance or (math.isnan(found) and math.isnan(expected))
        self.bad += not good
        self.lines.append(f"{'ok' if good else 'not ok'} {len(self.lines) + 1} - {what}: {found:.7g}, expected {expected:.7g}")

    def maps(self, what, found, expected, tolerance):
        worst = max(abs(a - b) for a, b in zip(found, expected))
        self.near(f"{what}, largest difference of a pixel", worst, 0, tolerance)


def main(tool):
    checks = Checks()
    with tempfile.TemporaryDirectory() as folder:
        for name, found, truth, ppd, exposure in pairs():
            found, truth = rounded(found), rounded(truth)
            report, low_map, high_map = library(tool, folder, found, truth, ppd, exposure)
            display = [zipped(lambda c: tuple(clipped(2**exposure * v) for v in c), image) for image in (found, truth)]
            expected = flat(flip(*display, ppd))
            # floats: seven digits of what is filtered; a square root makes 1e-9 of an edge that both have 3e-5
            checks.near(f"{name}: FLIP", report["flip"], mean(expected), 5e-5)
            checks.maps(f"{name}: FLIP", low_map, expected, 2e-4)
            if name != "more than half is black":
                start, stop, count = exposures(truth)
                checks.near(f"{name}: start exposure", report["start"], start, 1e-5)
                checks.near(f"{name}: stop exposure", report["stop"], stop, 1e-5)
            else:  # the median is that of all values that are not black
                rest = [[c for c in flat(truth) if any(v > 0 for v in c)]]
                start, stop, count = exposures(rest)
                checks.near(f"{name}: stop exposure", report["stop"], stop, 1e-5)
            checks.near(f"{name}: exposures", report["exposures"], count, 0)
            expected = flat(hdr_flip(found, truth, ppd, start, stop, count))
            checks.near(f"{name}: HDR-FLIP", report["hdr_flip"], mean(expected), 5e-5)
            checks.maps(f"{name}: HDR-FLIP", high_map, expected, 2e-4)
            checks.near(f"{name}: SSIM", report["ssim"], ssim(found, truth, exposure), 2e-5)
        report, _, high_map = library(tool, folder, truth, truth, 20, 0)
        checks.near("equal images: FLIP", report["flip"], 0, 0)
        checks.near("equal images: HDR-FLIP", report["hdr_flip"], 0, 0)
        report, _, high_map = library(tool, folder, found, truth, 20, 0, -2, 1.5)
        checks.near("given exposures: how many", report["exposures"], 4, 0)
        checks.maps("given exposures: HDR-FLIP", high_map, flat(hdr_flip(found, truth, 20, -2, 1.5, 4)), 2e-4)
    print(f"1..{len(checks.lines)}")
    print("\n".join(checks.lines))
    return 1 if checks.bad else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
