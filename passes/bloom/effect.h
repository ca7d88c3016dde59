/* What glint knows of this effect beside its passes. Rows only, read by C (passes/row_kinds.py, EFFECT_KINDS). */
EFFECT(11, "Bloom", "picture with bloom", "Light of the brightest parts of the picture, scattered in lens and eye over their surroundings.")
RESULTS("bloomed")
NO_TRUTH("R G B", "bloom is no light of the scene; its closed forms are tested")
JUDGED_IN(ALL)
CALLED_FOR(surfaces)
TERM("unchanged: the effect works on it, or on the antialiased picture")
