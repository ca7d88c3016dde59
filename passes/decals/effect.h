/* What glint knows of this effect beside its passes. Rows only, read by C (passes/row_kinds.py, EFFECT_KINDS). */
EFFECT(7, "Decals", "G-buffer with decals", "Marks such as dirt, posters and bullet holes, which the engine drew into buffers of their own, blended into the G-buffer.")
RESULTS("albedo_full", "normal_full", "specular_full")
NO_TRUTH("R G B", "no capture holds the G-buffer that the engine blended; the blend is exact, and tested")
JUDGED_IN(SURFACES)
CALLED_FOR(decals)
TERM("of surfaces with decals: all that is computed of the G-buffer")
