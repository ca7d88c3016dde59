/* What glint knows of this effect beside its passes. Rows only, read by C (passes/row_kinds.py, EFFECT_KINDS). */
EFFECT(6, "Stipple smoothing", "smoothed picture", "The picture in which surfaces that the engine drew into every other pixel are mixed with what shows between them.")
RESULTS("unstippled")
NO_TRUTH("R G B", "the engine never has the picture without the pattern; closed forms are tested")
JUDGED_IN(ALL)
CALLED_FOR(stippled)
TERM("unchanged: the effect works on it")
