#!/usr/bin/env python3
"""The sources' formulas in double precision, by quadrature instead of the shaders' closed forms: tables, and a self-test."""
import math
import sys

THRESHOLD = 0.1  # relative to the lobe's peak; the slides ignore directions below it


def power_of_roughness(roughness):
    return 2 / roughness**4 - 2


def roughness_of_power(power):
    return (2 / (power + 2)) ** 0.25


def angle_of_power(power, threshold=THRESHOLD):
    """The angle at which cosⁿ falls to the threshold."""
    return math.acos(threshold ** (1 / power))


def power_of_angle(angle, threshold=THRESHOLD):
    return math.log(threshold) / math.log(math.cos(angle))


def lobe(power, up_to=math.pi / 2, nodes=400):
    """Midpoint nodes (angle, weight) of a density ∝ cosⁿ per solid angle below `up_to`; weights sum to 1."""
    up_to = min(up_to, 6 / math.sqrt(power)) if power > 16 else up_to
    step = up_to / nodes
    angles = [(i + 0.5) * step for i in range(nodes)]
    weights = [math.exp(power * math.log(math.cos(a))) * math.sin(a) for a in angles]
    total = sum(weights)
    return [(a, w / total) for a, w in zip(angles, weights)]


def disc(radius, nodes=400):
    """Directions evenly distributed over a cone."""
    step = radius / nodes
    weights = [math.sin((i + 0.5) * step) for i in range(nodes)]
    return [((i + 0.5) * step, w / sum(weights)) for i, w in enumerate(weights)]


def reflected(normals):
    """At normal incidence a normal tilted by θ turns the ray by 2θ."""
    return [(2 * a, w) for a, w in normals]


def rms(nodes):
    return math.sqrt(sum(w * a * a for a, w in nodes))


def convolved(rays, cone, turns=16):
    """Angles from the axis of directions at the angle `cone` around `rays`."""
    result = []
    for a, wa in rays:
        for b, wb in cone:
            for k in range(turns):
                c = math.cos(a) * math.cos(b) + math.sin(a) * math.sin(b) * math.cos((k + 0.5) * math.pi / turns)
                result.append((math.acos(max(-1, min(1, c))), wa * wb / turns))
    return result


def farthest_apart(found, wanted, steps=256):
    """The largest difference of the fractions of directions within an angle (Kolmogorov's distance)."""
    top = max(a for a, _ in wanted)
    sums = [[0.0] * (steps + 1), [0.0] * (steps + 1)]
    for which, nodes in enumerate((found, wanted)):
        for a, w in nodes:
            sums[which][min(steps, int(a / top * steps))] += w
    apart = total = 0.0
    for f, w in zip(*sums):
        total += f - w
        apart = max(apart, abs(total))
    return apart


def slides_cone(power, share):
    """In the slides, the MIP level covers (1 - share) of the normal's angle."""
    return (1 - share) * angle_of_power(power)


def mean_cosine(nodes):
    return sum(w * math.cos(a) for a, w in nodes)


def filling_cone(rays, target):
    """The cone whose filter cosᵐ, with the threshold at its rim, has the ratio of both mean directions as its mean cosine."""
    lacking = mean_cosine(target) / mean_cosine(rays)
    low, high = 1e-4, 1.5
    for _ in range(50):  # the filter's mean cosine decreases with the angle
        middle = (low + high) / 2
        if mean_cosine(lobe(power_of_angle(middle))) > lacking:
            low = middle
        else:
            high = middle
    return low


def compared(rays, cone, target):
    both = convolved(rays, lobe(power_of_angle(cone), nodes=40))
    return {"cone": cone, "mean": mean_cosine(both), "rms": rms(both), "apart": farthest_apart(both, target)}


HORIZON = math.pi / 4  # of normals, seen along the surface normal: rays turn by twice the angle


def combined_rows(powers, shares):
    """For each power and share: the whole lobe above the horizon, the slides' sum of rays and cone, and ours."""
    for power in powers:
        angle = angle_of_power(power)
        target = reflected(lobe(power, HORIZON))
        for share in shares:
            rays = reflected(lobe(power, min(share * angle, HORIZON), 60))
            yield {"power": power, "share": share, "angle": angle, "target": rms(target),
                   "slides": compared(rays, slides_cone(power, share), target),
                   "ours": compared(rays, filling_cone(rays, target), target)}


def ggx_rays(roughness, part, nodes=60):
    """Rays of the central `part` of GGX's normals, which are below tan² = α² u/(1 - u) with a probability of u."""
    alpha = roughness**2
    us = [part * (i + 0.5) / nodes for i in range(nodes)]
    return [(2 * math.atan(alpha * math.sqrt(u / (1 - u))), 1 / nodes) for u in us]


def ggx_rows(roughnesses, held_parts=(0.7, 0.8, 0.9, 0.95, 1), share=0.5, threshold=THRESHOLD):
    """The difference of rays and cone from the whole lobe if the cone covers a part of the lobe above the horizon."""
    for roughness in roughnesses:
        a2 = roughness**4
        above = 1 / (1 + a2)
        target = ggx_rays(roughness, above, 400)
        sine2 = min((threshold**-0.5 - 1) * a2 / (1 - a2), 1)
        t2 = math.tan(share * math.asin(math.sqrt(sine2))) ** 2
        kept = min(t2 / (a2 + t2), above)
        rays = ggx_rays(roughness, kept)
        held = [compared(rays, filling_cone(rays, ggx_rays(roughness, min(part, above), 400)), target)
                for part in held_parts]
        yield {"roughness": roughness, "kept": kept, "held": held}


def first_step(length, ratio, count):
    """Adds up the steps."""
    return length / sum(ratio**i for i in range(count))


def cube_level(angle, travelled, distance, face, texel_scale=3.5):
    """The radius of the cone's base in texels of a face that is 2 wide at distance 1."""
    radius_texels = math.tan(angle) * travelled / distance * face / 2
    return max(0.0, math.log2(radius_texels / texel_scale))


CHECKS = []


def check(what, found, expected, tolerance):
    CHECKS.append((what, found, expected, abs(found - expected) <= tolerance))


def self_test():
    check("roughness 0.5 is power 30", power_of_roughness(0.5), 30, 1e-12)
    check("power 30 is roughness 0.5", roughness_of_power(30), 0.5, 1e-12)
    check("power 30 falls to 0.1 at 0.3868", angle_of_power(30), 0.3868, 5e-5)
    check("and back", power_of_angle(angle_of_power(30)), 30, 1e-9)
    # FACTS: rounded to two digits
    angle = angle_of_power(30)
    half = reflected(lobe(30, angle / 2))
    check("target lobe, rms of the ray", rms(reflected(lobe(30))), 0.50, 0.01)
    check("cut at the threshold", rms(reflected(lobe(30, angle))), 0.44, 0.01)
    for factor, expected in ((0.5, 0.29), (1.0, 0.38), (1.3, 0.44)):
        both = convolved(half[::8], disc(factor * angle, 50))
        total = sum(w for _, w in both)
        check(f"half by rays, a cone of {factor} angles", rms([(a, w / total) for a, w in both]), expected, 0.01)
    # the mean square angle of a cosine lobe by its moments: E[1 - cos θ] = 1/(n + 2)
    for power in (2, 30, 1000):
        nodes = lobe(power)
        check(f"mean cosine of power {power}", sum(w * math.cos(a) for a, w in nodes), (power + 1) / (power + 2), 2e-5)
    # the combined lobe has the mean direction of the whole one; that of the slides is far narrower
    target = reflected(lobe(30, HORIZON))
    row = next(combined_rows([30], [0.5]))
    check("the cone gives the lobe's mean direction back", row["ours"]["mean"], mean_cosine(target), 1e-3)
    check("the slides' cone loses spread", row["slides"]["rms"], 0.29, 0.015)
    for row in combined_rows((14, 126, 1022), (0.25, 0.5, 0.75)):
        better = row["slides"]["apart"] / row["ours"]["apart"]
        check(f"{row['share']:g} of power {row['power']}: closer than the slides'", min(better, 2), 2, 1e-9)
    check("24 steps of ratio 1.2 to 300 m begin with", first_step(300, 1.2, 24), 0.76, 0.005)
    check("closed form of the series", first_step(300, 1.2, 24), 300 * 0.2 / (1.2**24 - 1), 1e-12)
    check("a cone with a base of 3.5 texels is level 0", cube_level(math.atan(3.5 / 256), 4, 4, 512), 0, 1e-12)
    check("of 14 texels, level 2", cube_level(math.atan(14 / 256), 4, 4, 512), 2, 1e-12)
    check("twice the way, one level more", cube_level(0.1, 8, 4, 512) - cube_level(0.1, 4, 4, 512), 1, 1e-12)
    print(f"1..{len(CHECKS)}")
    for i, (what, found, expected, good) in enumerate(CHECKS, 1):
        print(f"{'ok' if good else 'not ok'} {i} - {what}: {found:.6g}, expected {expected:.6g}")
    return 0 if all(c[3] for c in CHECKS) else 1


if __name__ == "__main__":
    sys.exit(self_test())
