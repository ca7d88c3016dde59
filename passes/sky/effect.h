/* What glint knows of this effect beside its passes. Rows only, read by C (passes/row_kinds.py, EFFECT_KINDS). */
EFFECT(14, "Sky and clouds", "picture with its sky", "The light that the atmosphere scatters to the camera, the stars behind it, and the clouds before both.")
RESULTS("composed_sky")
NO_TRUTH("R G B", "the sky of a capture is the engine's own picture of the same formulas; closed forms are tested")
JUDGED_IN(ALL)
CALLED_FOR(air)
TERM("in the pixels that show the sky: the sky in place of the captured one")
