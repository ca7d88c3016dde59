/* What glint knows of this effect beside its passes. Rows only, read by C (passes/row_kinds.py, EFFECT_KINDS). */
EFFECT(9, "Temporal antialiasing", "antialiased picture", "The mean of the picture over the area of each pixel, from the samples of many frames with jitter.")
RESULTS("antialiased")
TRUTH("truth.antialiased", "R G B")
JUDGED_IN(ALL)
CALLED_FOR(history)
TERM("unchanged: the effect works on it, or on the captured picture")
