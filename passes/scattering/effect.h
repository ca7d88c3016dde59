/* What glint knows of this effect beside its passes. Rows only, read by C (passes/row_kinds.py, EFFECT_KINDS). */
EFFECT(13, "Subsurface scattering", "diffuse light with scattering", "Light that enters skin and leaves it beside where it entered: diffuse light blurred as a profile of skin says.")
RESULTS("lit_scattered")
NO_TRUTH("R G B", "the light of a capture does not say how much of it scattered; closed forms are tested")
JUDGED_IN(SURFACES)
CALLED_FOR(skin)
TERM("of skin: the captured light blurred, in place of it")
