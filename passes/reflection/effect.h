/* What glint knows of this effect beside its passes. Rows only, read by C (passes/row_kinds.py, EFFECT_KINDS). */
EFFECT(1, "Reflections", "reflection", "Light that surfaces mirror: a lobe about the mirrored view ray, as wide as the surface is rough.")
RESULTS("reflection_stable", "reflection_sharp", "reflection")
TRUTH_BY(LOBE, "truth.reflection", "R G B")
RAYS("truth.mirror")
JUDGED_IN(REFLECTING)
CALLED_FOR(reflecting)
CLASSES("surface", "gbuffer", "material.roughness", CLASS("mirror-like", 0.1) CLASS("glossy", 0.5) CLASS("rough", INFINITY))
TERM("plus the reflection times what the surface reflects of it")
