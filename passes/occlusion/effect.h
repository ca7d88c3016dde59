/* What glint knows of this effect beside its passes. Rows only, read by C (passes/row_kinds.py, EFFECT_KINDS). */
EFFECT(2, "Ambient occlusion", "occlusion", "The fraction of the hemisphere over a surface, weighted by the cosine, in which nothing is nearer than a radius.")
RESULTS("occlusion")
TRUTH("truth.occlusion", "visibility")
JUDGED_IN(SURFACES)
CALLED_FOR(surfaces)
CLASSES("occluder", "truth.occlusion", "distance.Z", CLASS("near", 0.25) CLASS("farther", 1e6) CLASS("open", INFINITY))
TERM("less the captured indirect light that is occluded")
