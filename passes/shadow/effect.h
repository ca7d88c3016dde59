/* What glint knows of this effect beside its passes. Rows only, read by C (passes/row_kinds.py, EFFECT_KINDS). */
EFFECT(3, "Contact shadows", "sun's shadow", "The part of the sun's disc that a surface sees: what the screen shows near it hides the sun, or the engine's own shadow mask does.")
RESULTS("sun_shadow")
TRUTH("truth.sun", "visibility")
TRUTH_CHANNEL_BY(SHADOW_MASK, "visibility contact")
JUDGED_IN(SURFACES)
CALLED_FOR(sunlit)
CLASSES("sun", "truth.sun", "visibility", CLASS("in shadow", 0.05) CLASS("at the light's edge", 0.95) CLASS("lit", INFINITY))
TERM("less the sun's light where the captured mask lets it through and the traced shadow does not")
