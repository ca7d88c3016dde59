"""Which effects the sample scenes call for, and why not the others: two tables of docs/plans.md (tools/plans.py page)."""
import concurrent.futures
import json
import os
import tempfile

import pages

PRESETS = ("mafia_de_display", "gtav_display")
# Captures beside those that `glint sample SCENE` writes: what a scene can bring for effects that need more than the usual parts.
MORE = {"alley": "shadow,lamps,froxels", "courtyard": "shadow,decals,stipple", "lake": "caustics", "meadow": "sky", "portrait": "curvature"}
# The slot that makes what is seen of an effect; others prepare it.
SEEN = {"Reflections": "cubemap_trace", "Water": "water", "Glass": "transparency", "Occlusion": "ao_apply", "Contact shadows": "contact_apply", "Sun's shadow": "shadow_mask",
        "Indirect light": "indirect_apply", "Lamps": "light", "Decals": "decal_composite", "Skin": "sss_blur", "Stipple": "unstipple", "Sky": "sky_compose", "Clouds": "cloud_map",
        "Fog": "fog", "Light in the air": "froxel_blur", "Shafts": "shaft_march", "Bloom": "bloom_threshold", "Finished picture": "grade"}


def scenes(glint):
    return [line.split()[0] for line in pages.run(glint, "sample", "--list").splitlines()[1:] if line.strip()]


def planned(glint, folder, scene, also):
    path = os.path.join(folder, f"{scene}-{also.replace(',', '-')}.exr")
    pages.run(glint, "sample", scene, "-o", path, "--size", "160x90", "--cube-size", "32", "--light", "4", *(["--also", also] if also else []))
    found = {}
    for preset in PRESETS:
        for step in json.loads(pages.run(glint, "plan", path, "--preset", preset, "--json"))["passes"]:
            if step["runs"] or step["slot"] not in found:
                found[step["slot"]] = step
    os.remove(path)
    return found


def tables(glint):
    """The matrix, and why an effect does not run."""
    cases = [(scene, "") for scene in scenes(glint)] + list(MORE.items())
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(max(1, (os.cpu_count() or 2) // 2)) as pool:
        plans = list(pool.map(lambda case: planned(glint, folder, *case), cases))
    rows, why = [], {}
    for (scene, also), plan in zip(cases, plans):
        name = f"`{scene}`" + (f" with {also.replace(',', ', ')}" if also else "")
        row = [name]
        for effect, slot in SEEN.items():
            last = plan[slot]
            row.append("runs" if last["runs"] else "")
            if not last["runs"]:
                why.setdefault((effect, last["reason"]), []).append(name)
        rows.append(row)
    reasons = []
    for (effect, reason), names in sorted(why.items(), key=lambda item: list(SEEN).index(item[0][0])):
        alone = len([1 for other, _ in why if other == effect]) == 1
        reasons.append([effect, reason, "all others" if alone and len(names) > 1 else ", ".join(names)])
    return pages.table(["capture", *SEEN], rows), pages.table(["effect", "why it does not run", "captures"], reasons)
