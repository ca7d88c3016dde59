/* What glint knows of this effect beside its passes. Rows only, read by C (passes/row_kinds.py, EFFECT_KINDS). */
EFFECT(12, "The finished picture", "finished picture", "The picture as a display shows it: exposure, what a lens does, tone curve, colours, grain.")
RESULTS("graded")
NO_TRUTH("R G B", "how a picture is displayed is the engine's choice; closed forms are tested")
JUDGED_IN(ALL)
CALLED_FOR(surfaces)
TERM("unchanged: the effect works on it, on the antialiased picture or on that with bloom")
