/* What glint knows of this effect beside its passes. Rows only, read by C (passes/row_kinds.py, EFFECT_KINDS). */
EFFECT(10, "The picture", "picture", "The light of all opaque surfaces with every effect that the pipeline has.")
RESULTS("composed_transparent", "composed_water", "composed")
TRUTH("truth.picture", "R G B")
JUDGED_IN(SURFACES)
CALLED_FOR(surfaces)
CLASSES("surface", "gbuffer", "material.roughness", CLASS("mirror-like", 0.1) CLASS("glossy", 0.5) CLASS("rough", INFINITY))
TERM("made of the terms of all effects")
OF_ALL_EFFECTS
