/* What glint knows of this effect beside its passes. Rows only, read by C (passes/row_kinds.py, EFFECT_KINDS). */
EFFECT(8, "Fog and shafts of light", "picture in fog", "The light that the air absorbs on its way to the camera, and the light that it scatters there, less where it lies in the shadow of the sun.")
RESULTS("composed_fog")
NO_TRUTH("R G B", "the truths of captures are of pictures without fog; closed forms are tested")
JUDGED_IN(ALL)
CALLED_FOR(fog)
TERM("times the light that passes the fog, plus what the fog scatters")
