/* What glint knows of this effect beside its passes. Rows only, read by C (passes/row_kinds.py, EFFECT_KINDS). */
EFFECT(5, "Deferred lights", "light of lamps", "The direct diffuse light of the point and spot lights that the capture's attributes describe, on the surfaces of the G-buffer.")
RESULTS("light")
TRUTH("truth.lamps", "R G B")
JUDGED_IN(SURFACES)
CALLED_FOR(lamplit)
TERM("plus the light of the lamps, less what the capture has of it")
