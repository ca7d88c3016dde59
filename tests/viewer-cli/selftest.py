"""glint selftest: passes here, says what it claims, has a case for every shared function: selftest.py GLINT PASSES FEW_DEVICES, the
last a library of few_devices.c. With MUTANTS as a fourth argument: every case fails for a wrong function. Speaks TAP."""
import concurrent.futures
import json
import os
import re
import subprocess
import sys
import tempfile

import tap

GLINT, PASSES, FEW_DEVICES = sys.argv[1:4]
# A file of passes/ (of passes/shared if no folder is named), a piece of it, its replacement, and a case that must fail: every case occurs.
MUTANTS = [
    ("stable", "abs(x) > 0.35", "abs(x) > 0.0", ["expm1 near zero"]),
    ("stable", "return exp(x) - 1.0;", "return exp(x);", ["expm1 far from zero", "expm1 far below zero"]),
    ("stable", "abs(x) > 0.5", "abs(x) > 0.0", ["log1p near zero"]),
    ("stable", "return log(1.0 + x);", "return log(1.00001 + x);", ["log1p far from zero", "log1p near its pole"]),
    ("stable", "i < 3", "i < 2", ["arc", "angle from versine"]),
    ("stable", "x / 2.0 * (1.0 - x / 12.0", "x / 2.0 * (1.0 - x / 11.9", ["versine"]),
    ("stable", "- 4.37113883e-8", "", ["cone radius"]),
    ("stable", "normalize(v / max(a.x, max(a.y, a.z)))", "normalize(v)", ["mirror direction", "unit vectors"]),
    ("stable", "420.0 - 15.0 * x2", "420.0 - 14.0 * x2", ["tangent"]),
    ("stable", "k > 2.0", "k > 3.0", ["expm1 beyond its tangent"]),
    ("constants", "floatBitsToUint(color) - (most + 1u)", "floatBitsToUint(color) - floatBitsToUint(0.99 * largest)", ["storable colours"]),
    ("stable", "0x0FFFu", "0x1000u", ["nearest half"]),
    ("constants", "lessThan(abs(color), vec4(LARGEST))", "lessThan(color, vec4(LARGEST))", ["finite colours"]),
    ("steps", "if (x == 0.0)", "if (abs(x) < 1e-6)", ["first step"]),
    ("steps", "min(log(rest), 0.0)", "0.0", ["ratio of steps"]),
    ("steps", "log(n) + 0.5 * (n - 1.0) * x", "log(n)", ["ratio of steps near one"]),
    ("cone", "(0.5 * face_size);", "face_size;", ["cone of a level"]),
    ("cone", "log1p(tangent * tangent)", "log(1.0 + tangent * tangent)", ["power of a cone"]),
    ("cone", "travelled_m < LARGEST ?", "true ?", ["level of a cube map"]),
    ("cone", "exp2(last)", "last", ["level of the screen"]),
    ("fog", "abs(fall) < 1e-6", "abs(fall) < 1e-2", ["fog along a ray"]),
    ("fog", "climb > 0.0 ?", "climb < 0.0 ?", ["fog without end"]),
    ("fog", "length_m <= 0.0", "length_m < -1.0", ["even fog"]),
    ("fog", "return -expm1(-optical_depth)", "return 1.0 - exp(-optical_depth)", ["fog factor"]),
    ("random", "v >> 16u", "v >> 15u", ["random numbers", "hash"]),
    ("interface", "frame.counts.y + frame", "frame.counts.x + frame", ["number of a frame"]),
    ("blue_noise", "0x05526C56u", "0x05526C57u", ["Owen's scrambling", "Owen's scrambling is one"]),
    ("blue_noise", "i + word[i] % (4u - i)", "i + word[i] % 2u * uint(i < 3u)", ["shuffled digits"]),
    ("blue_noise", "0x50B0u + ray / RAYS_SPREAD", "0x50B0u", ["points of rays"]),
    ("blue_noise", "frame_number / FRAMES, ray", "frame_number, ray", ["blue noise"]),
    ("blue_noise", "direction ^= direction >> 1u", "direction >>= 1u", ["low-discrepancy points"]),
    ("blue_noise", "0x33333333u", "0x33333331u", ["spread bits"]),
    ("bayer", "0, 8, 2, 10", "0, 8, 10, 2", ["ordered dither"]),
    ("plus", "2u * pixel.y", "3u * pixel.y", ["plus pattern"]),
    ("cubemap", "a.z >= a.x && a.z >= a.y", "a.z > a.x && a.z > a.y", ["face of a direction"]),
    ("cubemap", "vec3(p.x, 1.0, p.y)", "vec3(p.x, 1.0, -p.y)", ["direction of a face", "texel of a direction"]),
    ("cubemap", "v = d / max(a.x, max(a.y, a.z))", "v = d", ["width of a texel"]),
    ("camera", "view_from_uv.zw, front", "view_from_uv.wz * 1.001, front", ["position of a pixel"]),
    ("camera", "uv_from_view.xy + uv_from_view.zw", "uv_from_view.xy - uv_from_view.zw", ["pixel of a position"]),
    ("camera", "depth_m < LARGEST &&", "", ["which pixels reflect"]),
    ("camera", "pick >> 1u", "pick >> 2u", ["picked positions"]),
    ("camera", "pick, size) / vec2(size.xy)", "pick, size) / vec2(2u * size.zw)", ["picked uv"]),
    ("cube_chain", "+ 0.5) / float(size)", "+ 0.25) / float(size)", ["centre of a texel"]),
    ("cube_chain", "if (!finite(color)) continue;", "", ["box mean of a face"]),
    ("cube_chain", "x <= reach", "x < reach", ["pre-filtered texels"]),
    ("cocoon", "6.0 * float(place)", "float(place)", ["gauge of a cocoon"]),
    ("cocoon", "else if (inside)", "else", ["rays that leave a cocoon"]),
    ("active", "distance2 < best_distance2", "distance2 > best_distance2", ["nearest active cube map"]),
    ("facet", "abs(slopes.x) + abs(slopes.y)", "slopes.x + slopes.y", ["rise of a facet"]),
    ("facet_at", "2.0 / depth_m - 1.0 / after", "1.0 / depth_m", ["neighbours of a facet"]),
    ("facet_at", "(vec2(at) + 0.5) / size", "vec2(at) / size", ["facet of a texel"]),
    ("surface_at", "texelFetch(pick, texel, 0).x", "0u", ["surface of a texel"]),
    ("neighbour", "center.depth_m, depth_part", "center.depth_m, 2.0 * depth_part", ["weight of a neighbour"]),
    ("neighbour", "float(agreement > 0.0)", "1.0", ["equal weight of a neighbour"]),
    ("list_maker", "ROUGH_ALONE = 0u, ROUGH_AND_SMOOTH = 1u", "ROUGH_ALONE = 1u, ROUGH_AND_SMOOTH = 0u", ["list of tiles", "list of rays"]),
    ("work_list", "uint(TILE_WIDE) - 1u", "0u", ["list of tiles"]),
    ("work_list", "lane / wide % wide", "0u", ["texels of tiles", "texels of a list of rays"]),
    ("work_list", "uint(TILE_WIDE) / uint(scale)", "uint(TILE_WIDE)", ["texels of tiles at half resolution"]),
    ("facet", "normal.xy * view_from_uv.xy", "normal.yx * view_from_uv.xy", ["facet of a normal"]),
    ("facet", "abs(after) < abs(before)", "abs(after) > abs(before)", ["facet of depths"]),
    ("levels", "(high - 1) / size", "high / size", ["footprint of a texel"]),
    ("levels", "<= reach * reach", "< reach * reach", ["taps of a lattice"]),
    ("edges", "* 3.0 + 0.5", "* 3.0", ["packed edges"]),
    ("edges", "max(across[y] * down[x ^ 1u]", "min(across[y] * down[x ^ 1u]", ["edges of a block"]),
    ("edges", "place >> 3 + level", "place >> 2 + level", ["picked texel of a block"]),
    ("levels", "+ 3.0) * log1p(r2)", "+ 2.0) * log1p(r2)", ["taps of a pre-filter"]),
    ("sampling", "log(0.5) * 0.5 * power", "log(0.5) * power", ["cone of a cut lobe"]),
    ("paraboloid", "d.z < 0.0 ? 1.0 : 0.0", "d.z < 0.0 ? 0.0 : 1.0", ["place on a paraboloid"]),
    ("paraboloid", "upper ? 1.0 - r2 : r2 - 1.0", "1.0 - r2", ["direction of a paraboloid"]),
    ("paraboloid", "- 1.0) * paraboloid_reach(widest)", "- 1.0) * paraboloid_reach(size)", ["texel on a paraboloid"]),
    ("paraboloid", "4.0 / (wide * wide)", "4.0 / wide", ["solid angle on a paraboloid"]),
    ("paraboloid", "(1.0 + abs(height))", "(1.0 + height)", ["level of a paraboloid"]),
    ("paraboloid", "normalize(along - dot(along, up) * up)", "normalize(along)", ["paraboloid's axes"]),
    ("sampling", "(1.0 + r2) / (r2 * r2)", "(1.0 + r2) / r2", ["power of a roughness"]),
    ("sampling", "2.0 * (1.0 - roughness) * (1.0 + roughness) * (1.0 + r2) / (r2 * r2)", "2.0 / (r2 * r2) - 2.0", ["power of a rough surface"]),
    ("sampling", "(2.0 - 2.0 * r4)", "(2.0 - r4)", ["angle of a roughness", "angle of a rough surface"]),
    ("sampling", "float inverse = r4 / (2.0 - r4)", "float inverse = r4 / 2.0", ["Blinn-Phong half-vectors"]),
    ("sampling", "inversesqrt(threshold) - 1.0", "inversesqrt(threshold)", ["GGX's cut", "GGX that is kept"]),
    ("sampling", "kept * u.x * (1.0 + stretched.z)", "kept * u.x * 2.0", ["GGX visible normals"]),
    ("sampling", "if (x > 0.5) mean", "if (x > 0.01) mean", ["GGX's spread", "GGX's spread, narrow"]),
    ("sampling", "expm1_rest(-t * x)", "0.0", ["Blinn-Phong's spread"]),
    ("sampling", "GGX_HELD = 0.9", "GGX_HELD = 0.91", ["cone of a cut GGX lobe"]),
    ("brdf", "4.6069", "4.0", ["environment BRDF"]),
    ("brdf", "3.0764", "2.0", ["environment BRDF at grazing angles"]),
    ("sampling", "2.0 / (1.0 + cosine * cosine)", "1.0", ["cone that fills a lobe"]),
    ("sampling", "n.z >= 0.0 ? 1.0 : -1.0", "1.0", ["tangent frames"]),
    ("brdf", "(index * index)", "index", ["reflectance of glass"]),
    ("brdf", "albedo, metalness", "albedo, metalness * metalness", ["reflectance at normal incidence"]),
    ("brdf", "max(f0.g, f0.b)", "f0.g", ["reflectance at grazing incidence"]),
    ("brdf", "c * c * c * c * c", "c * c * c * c", ["environment of a mirror"]),
    ("facet", "depth_m == other_m ? 0.0", "depth_m == other_m ? 1e-9", ["equal depths"]),
    ("cocoon", "vec2(texel) / float(COCOON_SIZE - 1)", "vec2(texel) / float(COCOON_SIZE)", ["cocoon of a sphere"]),
    ("shown", "metalness[i] == 0.0 && specular", "metalness[i] == 0.0 || specular", ["shown reflections"]),
    ("reuse", "float away = min(0.5 * dot(apart, apart), 1.0)", "float away = 1.0 - dot(surface.xyz, other.xyz)", ["agreement of lobes"]),
    ("reuse", "float(x >= to)", "float(x < to)", ["fade"]),
    ("reuse", "abs(dot(offset, normal))", "dot(offset, normal)", ["in a plane"]),

    ("previous_frame/history.glsl", "age = total;", "age = past.age + 1.0;", ["colours that are none"]),
    ("previous_frame/history.glsl", "min(past.age, allowed)", "past.age", ["running mean", "history of one"]),
    ("previous_frame/history.glsl", "< history_normal", "< history_normal + 0.02", ["steps of normals"]),
    ("previous_frame/history.glsl", "if (!in_plane(seen - where.expected, normal, depth_m, history_depth)) continue;", "", ["steps of depth", "objects entering"]),
    ("previous_frame/history.glsl", "all(lessThanEqual(where.uv, vec2(1.0)))", "true", ["motion by parts of pixels"]),
    ("previous_frame/history.glsl", "!finite(color) || color.a < 0.0", "!finite(color)", ["rays that found nothing"]),
    ("reflection/temporal/rough.comp", "halves ? nearest_half(color) : color", "color - 3e-4 * color", ["mean in halves"]),
    ("reflection/temporal/rough.comp", "past.age == 0.0 && extra", "extra", ["samples for what is new"]),
    ("reflection/temporal/outliers.comp", "bright > most", "bright > 2.0 * most", ["single bright samples"]),
    ("reflection/temporal_sharp/clamped.comp", "color -= first", "color -= 0.0", ["neighbours without variance", "neighbours nearly equal"]),
    ("reflection/temporal_sharp/clamped.comp", "1.0 - roughness / sharp_roughness", "1.0 - roughness", ["history within its neighbours"]),
    ("reflection/temporal_sharp/clamped.comp", "1.0 / (longest + 1.0)", "1.0 / longest", ["mean of mirrors", "mean of mirrors, 3:1"]),
    ("reproject", "frame.previous_uv_from_view.zw - frame.uv_from_view.zw", "vec2(0.0)", ["jitter", "jitter in motion vectors"]),
    ("reproject", "- 1e-6, 0.0)", ", 0.0)", ["views of mirrors that turn"]),
    ("reproject", "position + normalize(position) * travelled_m", "position", ["reflections' places"]),
    ("reproject", "divergence * 2.0", "divergence", ["views that turn"]),
    ("reproject", "view.z * front > 0.0 ?", "true ?", ["behind the camera before"]),
    ("hemisphere", "e - sine * cosine", "e + sine * cosine", ["occluded part of a slice"]),
    ("hemisphere", "HALF_PI + gamma", "HALF_PI", ["side of a slice"]),
    ("hemisphere", "radius = sqrt(u.x)", "radius = u.x", ["cosine-weighted direction"]),
    ("light_terms", "min(sun.mask, sun.shadow)", "sun.shadow", ["changed light"]),
    ("light_terms", "1.0 / 64.0", "1.0 / 63.0", ["kept light"]),
    ("light_volume", "direction[i] < 0.0", "direction[i] > 0.0", ["ambient cube"]),
    ("light_volume", "/ 6.0", "/ 5.0", ["ambient cube"]),
    ("light_volume", "1.0 + 2.0 * dot", "1.0 + 3.0 * dot", ["directed light"]),
    ("light_volume", "contrast * (irradiance - mean), 0.0)", "contrast * (irradiance - mean), -1.0)", ["contrasted light"]),
    ("light_volume", "cell.y + cell.z * int(grid.y)", "cell.y + cell.z * int(grid.x)", ["cell of a volume"]),
    ("reuse", "return part * part;", "return part;", ["agreement of GGX lobes"]),
    ("sun", "tan(angle) * sqrt(u.x)", "tan(angle) * u.x", ["direction in the sun's disc"]),
    ("sun", "(part * most_m)", "most_m", ["fade at the end"]),
    ("sun", "captured > 0.0 ? min(captured, 1.0) : 0.0", "min(captured, 1.0)", ["valid mask"]),
    ("sun", "min(inside.x, inside.y) / part", "inside.x / part", ["fade at the border"]),
    ("active", "if ((bits >> i & 1u) == 0u) continue;", "", ["nearest of some active cube maps"]),
    ("active", "(frame.distances.x >> place & 1u) != 0u", "(frame.distances.x >> place & 1u) == 0u", ["cube maps with distances"]),
    ("plus", "(2u * major + minor) % 5u, major", "minor, major", ["strata of pluses"]),
    ("levels", "- y * y) + 0.5", "- y * y) - 0.5", ["taps of a row"]),
    ("cube_filter", "across * (1.0 - along)", "along * (1.0 - across)", ["texels around a direction"]),
    ("sampling", "8.0 * max(dot(h, view), 0.0)", "4.0 * max(dot(h, view), 0.0)", ["solid angle of a Blinn-Phong ray"]),
    ("sampling", "return a2 > 0.0 ? 2.0 * (z", "return a2 > 0.0 ? (z", ["solid angle of a GGX ray"]),
    ("sampling", "a2 / max(1.0 - a2, 1e-6), 1.0)", "a2, 1.0)", ["angle of a GGX lobe"]),
]


def selftest(*arguments, status=0, **environment):
    run = subprocess.run([GLINT, "selftest", *arguments], capture_output=True, text=True, env={**os.environ, "GLINT_VALIDATION": "1", **environment})
    assert run.returncode == status, (arguments, run.returncode, run.stdout, run.stderr)
    return run


def functions():
    """The names that passes/shared defines."""
    names = set()
    for entry in os.scandir(os.path.join(PASSES, "shared")):
        if not entry.name.endswith(".glsl"):
            continue
        with open(entry.path, encoding="utf-8") as source:
            text = re.sub("//.*", "", source.read())
        names |= set(re.findall(r"^(?:precise )?\w+ (\w+)\([^;{]*\)\s*[{;]", text, re.M))
    return names


def cases(*arguments, status=0):
    return json.loads(selftest("--json", *arguments, status=status).stdout)["cases"]


def killed_by(mutant):
    """The cases that fail with one file changed."""
    file, old, new, names = mutant
    file = file if "/" in file else os.path.join("shared", file + ".glsl")
    with open(os.path.join(PASSES, file), encoding="utf-8") as source:
        text = source.read()
    assert old in text, (file, old)
    with tempfile.TemporaryDirectory() as folder:
        os.makedirs(os.path.join(folder, os.path.dirname(file)))
        with open(os.path.join(folder, file), "w", encoding="utf-8") as changed:
            changed.write(text.replace(old, new))
        only = [word for name in names for word in ("--only", name)]
        run = subprocess.run([GLINT, "selftest", "--json", "--quick", "--passes", folder, *only], capture_output=True, text=True)
    assert run.returncode in (0, 1) and run.stdout, (mutant, run.stderr)
    failed = {case["name"] for case in json.loads(run.stdout)["cases"] if not case["pass"]}
    assert run.returncode == (1 if failed else 0)
    return failed


class Tests:
    def test_every_case_passes_here(self):
        found = cases("--quick")
        assert all(case["pass"] and case["values"] >= (500 if case["group"] in ("functions", "geometry", "time") else 1) for case in found), [c for c in found if not c["pass"]]
        assert len(found) >= 220

    def test_every_case_has_a_bound_with_its_reason(self):
        listed = cases("--list")
        assert all(case["what"] and case["reason"] and case["bound"] >= 0 and "pass" not in case for case in listed)
        assert len({case["name"] for case in listed}) == len(listed)

    def test_only_chooses(self):
        names = {case["name"] for case in cases("--list", "--only", "fog")}
        assert names == {"fog along a ray", "fog without end", "even fog", "fog factor", "mean of what passes"}, names
        assert "no case has that" in selftest("--only", "no such thing", status=2).stderr

    def test_the_table_says_where_it_is_worst(self):
        lines = selftest("--quick", "--only", "versine").stdout.splitlines()
        assert lines[0].startswith("functions: ")
        assert lines[2].split() == ["case", "worst", "bound", "ties", "worst", "at"]
        assert any(line.startswith("versine ") and " pass " in line and " angle " in line for line in lines), lines
        assert any(line.split()[:4] == ["functions", "2", "0", "0"] for line in lines), lines
        assert lines[-1].split(":")[1].strip() == "2 cases, 0 failed", lines[-1]

    def test_what_fails_is_said_again_with_its_claim(self):
        with tempfile.TemporaryDirectory() as folder:
            os.mkdir(os.path.join(folder, "shared"))
            with open(os.path.join(PASSES, "shared", "bayer.glsl"), encoding="utf-8") as source:
                text = source.read().replace("/ 16.0", "/ 15.0")
            with open(os.path.join(folder, "shared", "bayer.glsl"), "w", encoding="utf-8") as changed:
                changed.write(text)
            lines = selftest("--only", "dither", "--passes", folder, status=1).stdout.splitlines()
        failed = [line for line in lines if line.startswith("FAIL ")]
        assert len(failed) == 1 and "ordered dither (the Bayer matrix" in failed[0] and "expected" in failed[0], lines
        assert lines[-1].endswith("1 cases, 1 failed"), lines[-1]

    def test_groups_that_get_no_device_beside_others_run_after_them(self):
        only = ("--json", "--quick", "--only", "versine", "--only", "roughness 0", "--only", "inches")
        wanted = json.loads(selftest(*only).stdout)
        for what, refused in (("open", "refused a device"), ("memory", "refused memory")):
            run = selftest(*only, LD_PRELOAD=FEW_DEVICES, FEW_DEVICES=what, ASAN_OPTIONS="verify_asan_link_order=0")
            found = json.loads(run.stdout)
            assert refused in run.stderr or os.cpu_count() == 1, (what, run.stderr)
            assert found["cases"] == wanted["cases"] and [g["name"] for g in found["groups"]] == ["functions", "geometry", "invariance"], found

    def test_every_shared_function_has_a_case(self):
        evaluated = " ".join(case.get("evaluated", "") for case in cases("--list"))
        missing = [name for name in functions() if not re.search(rf"\b{name}\b", evaluated)]
        assert len(functions()) > 100 and not missing, missing


class Mutants:
    def test_every_case_finds_a_wrong_function(self):
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            failed = list(pool.map(killed_by, MUTANTS))
        listed = [case for case in cases("--list") if case["group"] == "functions"]
        shared = {case["name"] for case in listed if any(re.search(rf"\b{name}\(", case.get("evaluated", "")) for name in functions())}
        survived = [(mutant, name) for mutant, names in zip(MUTANTS, failed) for name in mutant[3] if name not in names]
        killed = set().union(*failed)
        assert not survived, survived
        assert shared <= killed, shared - killed


sys.exit(tap.run(Mutants() if sys.argv[4:] else Tests()))
