"""The mechanisms of docs/mechanisms.md: the switch that turns each off, the scene, the figure that is compared, what is traded for it, and the
explanation where nothing is gained.

Scenes:
    NAME            one frame
    still:NAME      a shot of a static, jittered camera, whose truth covers the pixels' areas
    centred:NAME    the same, with rays through the pixels' centres
    moving:NAME     a shot of an unjittered camera that moves sideways
    full:NAME       one frame at 1920x1080, for times"""


def surface(rows, name):
    return next(r for r in rows if r["surfaces"] == name)


def fallen(against):
    """Rays that no cube map could follow, and their error."""
    fell = [r for r in against["rays"] if r["tracer"] == "cube map" and r["reason"] in ("shadow_region", "fallback", "no_cubemap")]
    count = sum(r["rays"] for r in fell)
    return count, sum(r["rays"] * r["radiance_error"] for r in fell) / max(count, 1)


def of_truth(what, kind, number="symmetric"):
    return (what, "truth", lambda a: surface(a["image"]["surfaces"], kind)[number])


def of_noise(what, kind, frame=16):
    return (what, f"noise {frame}", lambda a: surface(a["image"]["surfaces"], kind)["rmse"])


def of_mean(what, kind):
    """The absolute error of the mean."""
    return (what, "truth", lambda a: 100 * abs(surface(a["image"]["surfaces"], kind)["mean_error"]) / surface(a["image"]["surfaces"], kind)["truth_mean"])


PICTURE = of_truth("error of the reflection", "all")
SMOOTH = of_truth("error, mirror-like", "mirror-like")
GLOSSY = of_truth("error, glossy", "glossy")
ROUGH = of_truth("error, rough", "rough")
SMOOTH_RMSE = of_truth("RMSE, mirror-like", "mirror-like", "rmse")
GLOSSY_RMSE = of_truth("RMSE, glossy", "glossy", "rmse")
ROUGH_RMSE = of_truth("RMSE, rough", "rough", "rmse")
RAYS = ("mirror rays that do not end at the true hit, %", "truth", lambda a: 100 * (1 - surface(a["distances"], "mirror-like")["right"]))
MEDIAN = ("median error of mirror rays' distance, %", "truth",
          lambda a: 100 * surface(a["distances"], "mirror-like")["median_error"])
FALLEN = ("error over the rays that fell back", "truth", lambda a: fallen(a)[1])
COST = ("texture fetches a ray", "truth", lambda a: surface(a["distances"], "all")["fetches"])
NOISE_1 = of_noise("noise of the first frame, rough", "rough", 1)
NOISE = of_noise("noise of frame 16, rough", "rough")
STRAY_ROUGH = of_noise("noise and lag of frame 16, rough", "rough")
FLICKER = ("change from frame 15 to 16, mirror-like", "flicker", lambda a: surface(a["image"]["surfaces"], "mirror-like")["rmse"])
GLOSSY_MEAN = of_mean("deviation of the mean, glossy, %", "glossy")
ROUGH_MEAN = of_mean("deviation of the mean, rough, %", "rough")
TIME = ("ms of all passes", "time", lambda ms: ms)

MIRROR = ["set downsample.jitter=false"]
MANY = ["set pipeline.rays=16"]
LINEAR = ["use screen_trace=linear", "use hiz=none"]
CUBES = MIRROR + ["set screen_trace.length_m=0"]
PLUS = ["set downsample.pattern=plus"]
HISTORY = ["use temporal=rough", "use temporal_sharp=clamped"]
CAPPED = CUBES + ["set cubemap_trace.depth=capped"]
COCOON_ALONE = CUBES + ["set cubemap_trace.depth=captured", "set cubemap_trace.cocoon_start=surface"]
LQ_AS_HQ = "set cubemap_trace.steps_lq=24 set cubemap_trace.refinements_lq=4 set cubemap_trace.length_lq_m=300"

# (step, mechanism, scene, common settings, settings that turn it off, measured figure[, figure that it costs])
ROWS = [
    ("down-sampling", "edge detection", "room", MIRROR, "set downsample.edges=false", SMOOTH, "four depths compared"),
    ("down-sampling", "pick instead of a mixture", "room", MIRROR, "use downsample=bilinear", SMOOTH),
    ("down-sampling", "stippled surfaces split", "street", CUBES, "set downsample.tie=near", PICTURE,
     "half of the samples of the stippled surface"),
    ("down-sampling", "stippled surfaces split", "street", MIRROR, "set downsample.tie=near", SMOOTH),
    ("down-sampling", "half resolution", "room", MIRROR, "use downsample=none", SMOOTH, "error for time"),
    ("down-sampling", "half resolution", "full:street", [], "use downsample=none", TIME),
    ("down-sampling", "jitter by the NDF", "room", MANY, "set downsample.jitter=false", ROUGH, "noise for the lobe's shape"),
    ("down-sampling", "plus pattern", "centred:room", HISTORY + PLUS, "set downsample.pattern=white", NOISE_1),
    ("down-sampling", "plus pattern", "centred:room", HISTORY + PLUS, "set downsample.pattern=white", NOISE),
    ("down-sampling", "strata against the plus pattern", "centred:room", HISTORY, "set downsample.pattern=plus", NOISE_1),
    ("down-sampling", "strata against the plus pattern", "centred:room", HISTORY, "set downsample.pattern=plus", NOISE),
    ("down-sampling", "strata against the plus pattern", "street", [], "set downsample.pattern=plus", ROUGH_RMSE),
    ("down-sampling", "strata against blue noise", "centred:room", HISTORY, "set downsample.pattern=blue", NOISE_1),
    ("down-sampling", "strata against blue noise", "centred:room", HISTORY, "set downsample.pattern=blue", NOISE),
    ("down-sampling", "shuffle in each frame", "centred:room", HISTORY, "set downsample.shuffle=false", NOISE),
    ("down-sampling", "another pixel in each frame", "still:street", HISTORY, "set downsample.alternate=false", PICTURE),
    ("down-sampling", "another pixel in each frame", "centred:room", HISTORY, "set downsample.alternate=false", SMOOTH_RMSE),
    ("pre-filtering", "a cone for each ray", "room", [], "set downsample.cone_factor=0", ROUGH),
    ("pre-filtering", "a cone for each ray", "plaza", [], "set downsample.cone_factor=0", GLOSSY),
    ("pre-filtering", "rays over the whole lobe instead of its middle", "plaza", [], "set downsample.split=cut", GLOSSY_MEAN, "noise for the mean"),
    ("pre-filtering", "rays over the whole lobe instead of its middle", "plaza", [], "set downsample.split=cut", ROUGH_MEAN),
    ("pre-filtering", "rays over the whole lobe instead of its middle", "kitchen", [], "set downsample.split=cut", ROUGH_MEAN),
    ("pre-filtering", "29 taps", "room", [], "set cubemap_mips.reach=0", GLOSSY),
    ("pre-filtering", "29 taps", "room", [], "set cubemap_mips.reach=0", ROUGH),
    ("pre-filtering", "29 taps instead of 1009", "room", ["set cubemap_mips.reach=18"], "set cubemap_mips.reach=3", ROUGH),
    ("pre-filtering", "colour filtered for cones", "room", [], "use cubemap_mips=plain", GLOSSY),
    ("pre-filtering", "screen MIPs", "street", [], "use lit_mips=none", GLOSSY),
    ("pre-filtering", "sky MIPs", "street", [], "use sky_mips=none", ROUGH),
    ("screen trace (linear)", "dither", "street", LINEAR + MIRROR, "set screen_trace.dither=false", SMOOTH_RMSE, "banding for noise"),
    ("screen trace (linear)", "1/z between texels", "room", LINEAR + MIRROR, "set screen_trace.interpolate=false", RAYS),
    ("screen trace (linear)", "refinement", "room", LINEAR + MIRROR, "set screen_trace.refine=false", RAYS),
    ("screen trace (linear)", "verification of hits", "room", LINEAR + MIRROR, "set screen_trace.verify=false", RAYS),
    ("screen trace (linear)", "rejection of back faces", "room", LINEAR + MIRROR, "set screen_trace.back_faces=false", RAYS),
    ("screen trace", "pyramid against the linear march", "room", MIRROR, "use screen_trace=linear use hiz=none", RAYS, "time for error"),
    ("screen trace", "pyramid against the linear march", "street", [], "use screen_trace=linear use hiz=none", PICTURE),
    ("screen trace", "pyramid against the linear march", "full:street", [], "use screen_trace=linear use hiz=none", TIME),
    ("screen trace", "rays continue behind objects", "room", MIRROR, "set screen_trace.pass_behind=false", RAYS),
    ("screen trace", "assumed depth of objects", "room", MIRROR, "set screen_trace.solid=0", RAYS),
    ("screen trace", "128 cells, 48 for rough surfaces", "street", [], "set screen_trace.cells=96 set screen_trace.cells_lq=32", PICTURE, "time for error"),
    ("screen trace", "128 cells, 48 for rough surfaces", "plaza", [], "set screen_trace.cells=96 set screen_trace.cells_lq=32", ROUGH),
    ("screen trace", "ends in the sky", "street", MIRROR, "set screen_trace.sky=false", PICTURE),
    ("screen trace (linear)", "growing steps", "room", LINEAR + MIRROR, "set screen_trace.growth=1", RAYS),
    ("screen trace", "thickness", "room", MIRROR, "set screen_trace.thickness_m=1e6", RAYS),
    ("screen trace", "screen trace", "room", MIRROR, "set screen_trace.length_m=0", SMOOTH),
    ("active cube maps", "forced outdoor map", "hotel", MIRROR, "set cubemap_active.force_outdoor=false", SMOOTH),
    ("active cube maps", "vertical penalty", "hotel", MIRROR, "set cubemap_active.vertical_penalty=1", SMOOTH),
    ("best cube map", "score against the nearest", "room", CUBES, "use cubemap_select=nearest", SMOOTH),
    ("best cube map", "visibility", "room", CUBES, "set cubemap_select.visibility=0", RAYS),
    ("best cube map", "distance", "room", CUBES, "set cubemap_select.distance=0", RAYS),
    ("best cube map", "direction", "room", CUBES, "set cubemap_select.direction=0", SMOOTH),
    ("best cube map", "fade", "room", CUBES, "set cubemap_select.fade=0", RAYS),
    ("cube-map trace", "shadow regions (mass depth)", "room", CUBES, "set cubemap_trace.mass_m=1e6", RAYS),
    ("cube-map trace", "mass depth grows with the step", "room", CUBES, "set cubemap_trace.mass_step=0", RAYS),
    ("cube-map trace", "secant", "room", CUBES, "set cubemap_trace.secant=false", MEDIAN),
    ("cube-map trace", "verification of hits", "room", CUBES, "set cubemap_trace.verify=false", RAYS),
    ("cube-map trace", "distance between texels", "room", CUBES, "set cubemap_trace.bilinear=false", MEDIAN),
    ("cube-map trace", "random step scale per ray", "room", MANY, "set cubemap_trace.random_scale=false", PICTURE,
     "banding for noise"),
    ("cube-map trace", "step back after a switch", "room", CUBES, "set cubemap_trace.step_back=false", RAYS),
    ("cube-map trace", "inner volumes", "room", CUBES + ["set cubemap_trace.skip_volume=true"],
     "set cubemap_trace.skip_volume=false", RAYS),
    ("cube-map trace", "inner volumes", "room", CUBES + ["set cubemap_trace.skip_volume=true"],
     "set cubemap_trace.skip_volume=false", COST, "time for fetches"),
    ("cube-map trace", "inner volumes", "full:street", ["set cubemap_trace.skip_volume=true"],
     "set cubemap_trace.skip_volume=false", TIME),
    ("cube-map trace", "distance MIPs by roughness", "room", ["set cubemap_trace.rough_level=3"],
     "set cubemap_trace.rough_level=0", ROUGH),
    ("cube-map trace", "HQ/LQ split", "room", [], LQ_AS_HQ, ROUGH, "error for fetches and time"),
    ("cube-map trace", "HQ/LQ split", "room", [], LQ_AS_HQ, COST),
    ("cube-map trace", "HQ/LQ split", "full:street", [], LQ_AS_HQ, TIME),
    ("cube-map trace", "cocoon caps the sky", "street", CAPPED, "set cubemap_trace.depth=captured", SMOOTH, "fetches for error"),
    ("cube-map trace", "cocoon caps the sky", "street", CAPPED, "set cubemap_trace.depth=captured", COST),
    ("cocoon", "weighted maximum", "room", COCOON_ALONE, "set cocoon.reach=0", FALLEN),
    ("cocoon", "starts where the ray stopped", "room", MIRROR, "set cubemap_trace.cocoon_start=surface", FALLEN),
    ("cocoon", "ends inside objects", "room", MIRROR, "set cubemap_trace.solid=0", FALLEN),
    ("cocoon", "ends inside objects", "hotel", MIRROR, "set cubemap_trace.solid=0", FALLEN),
    ("cocoon", "maximum of pairs", "street", COCOON_ALONE, "set cocoon.maximum=samples", FALLEN),
    ("cocoon", "sky capped in finer levels", "street", CAPPED, "set cocoon.cap_sky=false", COST),
    ("classification", "lists of tiles with a ray", "full:street", ["use classify=tiles"], "use classify=none", TIME,
     "the pass that makes the list"),
    ("classification", "lists of tiles with unfinished rays", "full:room", ["use classify_unfinished=tiles"],
     "use classify_unfinished=none", TIME, "the pass that makes the list"),
    ("resolve", "colours of the hit's own surface", "plaza", [], "set resolve.joint=false set resolve_sharp.joint=false set lit_mips.exclude_sky=false", GLOSSY_MEAN),
    ("resolve", "colours of the hit's own surface", "plaza", [], "set resolve.joint=false set resolve_sharp.joint=false set lit_mips.exclude_sky=false", SMOOTH),
    ("resolve", "colours of the hit's own surface", "kitchen", MIRROR, "set resolve.joint=false set resolve_sharp.joint=false set lit_mips.exclude_sky=false", SMOOTH_RMSE),
    ("resolve", "bilinear colour", "street", MIRROR, "set resolve.filter_color=false", ROUGH_RMSE),
    ("blur", "five-sample blur", "centred:room", HISTORY, "use blur=none", NOISE_1, "sharpness for noise"),
    ("blur", "five-sample blur", "centred:room", HISTORY, "use blur=none", NOISE),
    ("blur", "five-sample blur", "street", [], "use blur=none", GLOSSY),
    ("blur", "BRDF weights", "street", [], "set blur.brdf=false", GLOSSY, "noise for detail"),
    ("temporal", "history", "centred:room", HISTORY, "use temporal=none", NOISE, "lag for noise"),
    ("temporal", "history, moving", "moving:room", HISTORY, "use temporal=none", STRAY_ROUGH),
    ("temporal", "history, moving", "moving:street", HISTORY, "use temporal=none", GLOSSY_RMSE),
    ("temporal", "extra samples where history is missing", "centred:room", HISTORY, "set temporal.extra=false", NOISE_1,
     "detail for noise"),
    ("temporal", "extra samples where history is missing", "moving:street", HISTORY, "set temporal.extra=false", ROUGH_RMSE),
    ("temporal", "divergence threshold", "moving:room", HISTORY, "set temporal.divergence=1e6", GLOSSY, "noise for lag"),
    ("temporal", "divergence threshold", "moving:street", HISTORY, "set temporal.divergence=1e6", GLOSSY),
    ("temporal", "rejection of other surfaces' history", "moving:room", HISTORY,
     "set temporal.history_depth=10 set temporal.history_normal=-1", ROUGH, "noise for lag"),
    ("upscale", "best match against bilinear", "street", [], "use upscale=bilinear", PICTURE, "blockiness for leaks"),
    ("upscale", "all eight surrounding texels", "street", [], "set upscale.around=false", PICTURE),
    ("upscale", "depth in the match", "room", [], "set upscale.depth_weight=0", ROUGH_RMSE),
    ("upscale", "normals in the match", "street", [], "set upscale.normal_weight=0", GLOSSY),
    ("upscale", "roughness in the match", "street", [], "set upscale.roughness_weight=0", GLOSSY),
    ("sharp", "resolve at full resolution", "room", [], "use resolve_sharp=none", SMOOTH, "time for error"),
    ("sharp", "hits of surrounding rays", "room", [], "set resolve_sharp.neighbours=false", SMOOTH, "time for error"),
    ("sharp", "hits of surrounding rays", "plaza", [], "set resolve_sharp.neighbours=false", SMOOTH),
    ("sharp", "temporal filter", "still:room", HISTORY, "use temporal_sharp=none", SMOOTH, "lag for stability"),
    ("sharp", "temporal filter", "still:street", HISTORY, "use temporal_sharp=none", SMOOTH),
    ("sharp", "temporal filter", "still:room", HISTORY, "use temporal_sharp=none", FLICKER),
    ("sharp", "temporal filter, moving", "moving:room", HISTORY, "use temporal_sharp=none", SMOOTH),
    ("sharp", "variance clamping", "still:street", HISTORY, "set temporal_sharp.clamp_history=false", SMOOTH, "flicker for lag"),
    ("sharp", "variance clamping", "moving:room", HISTORY, "set temporal_sharp.clamp_history=false", SMOOTH, "flicker for lag"),
]

# Why a row does not change, or changes in the wrong direction: (mechanism, measured figure or None for all).
PRICE = "this is its cost; its benefit is in the other row"
REASONS = {
    ("128 cells, 48 for rough surfaces", None): "the cube maps trace the rays that fewer cells leave unfinished about as well here, but not on plaza's rough surfaces",
    ("ends in the sky", "error of the reflection"): "the sky in the cube maps is the same as in the picture, and no cube map of street occludes it",
    ("colours of the hit's own surface", None): "on mirrors a screen hit with another depth was already rejected (`resolve_sharp.check_depth`); what is "
    "left are edges within a texel, which are as often wrong without the colours of neighbours as with them",
    ("variance clamping", "error, mirror-like"): "in motion the divergence threshold rejects the history of a mirror before the clamp is applied: both "
    "have the same bits; a still camera has a history to clamp",
    ("fade", None): "No cube map of this capture is being faded; gpu_cubemap_select tests the term.",
    ("inner volumes", "mirror rays that do not end at the true hit, %"): "The skipped part is empty.",
    ("inner volumes", "ms of all passes"): "few rays start in a volume or enter one; on a GPU the test costs more than it saves, so that the preset does not use it",
    ("half resolution", None): PRICE,
    ("pyramid against the linear march", "ms of all passes"): PRICE,
    ("rays over the whole lobe instead of its middle", "deviation of the mean, rough, %"): "both means are within 3 % of the truth, that of the "
    "middle because its errors cancel: pixel by pixel its rough surfaces are half as wrong again (symmetric error 0.148 against 0.104, 240×135)",
    ("extra samples where history is missing", "RMSE, rough"): "few pixels of a moving frame are without history; the benefit for these is in the "
    "row of the first frame",
    ("another pixel in each frame", None): "a jittered camera covers the block already. What remains is that the history of a texel contains "
    "pixels of other roughness; rejecting them removes that (-6 % on rough pixels of centred:street), but costs 3 % where the camera is jittered",
    ("29 taps", "error, rough"): "levels of a box filter are wider than their cone, which reduces noise where light is uniform; glossy "
    "pixels and street's RMSE need the narrower ones",
    ("29 taps instead of 1009", None): "29 taps are enough: the level is within 0.02 of the lobe, with 1009 within 0.002 (`gpu_mips`)",
    ("sky MIPs", None): "the skies of the scenes are smooth over the cones of the rays that end in them",
    ("dither", None): "steps are refined and hits verified: little depends on their start",
    ("visibility", None): "a cube map that sees the start from afar has coarse texels along the whole ray; NOTES.md has the weight on three scenes",
    ("random step scale per ray", None): "the secant finds the surface between any two steps, so that there is no banding without it, either",
    ("inner volumes", "texture fetches a ray"): "only a ray that starts inside is moved, and the surfaces of room lie outside of its boxes "
    "(`gpu_mirror_box`: 36,781 steps instead of 229,780)",
    ("distance MIPs by roughness", None): "one fetch is one fetch at any level; coarser levels only save cache, and it is off by default",
    ("HQ/LQ split", "error, rough"): PRICE,
    ("HQ/LQ split", "texture fetches a ray"): "in room few rays are rough and not finished on screen",
    ("HQ/LQ split", "ms of all passes"): "it saves 3 % of the fetches",
    ("lists of tiles with a ray", None): "nearly every pixel of the scenes reflects: making the list costs more than the excluded rays",
    ("lists of tiles with unfinished rays", None): "a wave without a ray ends at once: making the list costs more than that",
    ("ends inside objects", None): "the objects of hotel are thin for the size of its rooms: of the rays that stop inside the cocoon, 57 % truly "
    "continue behind the object, in room 41 %",
    ("bilinear colour", None): "a mirror shows texels as they are: interpolation is as often wrong as right",
    ("depth in the match", None): "where depth separates two surfaces, their normals or roughness nearly always differ, too: those of the "
    "rails, steps and leaves of the scenes do",
    ("history, moving", None): "bright lamps in a wet road: their reflection is far behind the surface that the history follows, and lags "
    "as much as the divergence threshold allows (without a threshold the row is worse still; `reprojection=reflection` has 14 % less RMSE). "
    "Rough pixels have 10 % less error by it",
    ("temporal filter, moving", None): "the reflection in a mirror does not move with its surface, and these frames have no jitter to benefit from: "
    "what the threshold and the clamp accept is lag",
}
