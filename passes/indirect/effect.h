/* What glint knows of this effect beside its passes. Rows only, read by C (passes/row_kinds.py, EFFECT_KINDS). */
EFFECT(4, "Indirect diffuse light", "indirect light", "The radiance that a white surface would send back of the light that arrives from other surfaces and the sky: their irradiance divided by π.")
RESULTS("indirect")
TRUTH("truth.indirect", "R G B")
JUDGED_IN(SURFACES)
CALLED_FOR(bounce)
TERM("plus the indirect light times the diffuse albedo, less the captured indirect light")
