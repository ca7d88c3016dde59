/* The parts of a capture whose presence the survey records. Rows only, read by C. SURVEY_PART(figure, part) */
SURVEY_PART(has_sky, GLINT_PART_SKY)
SURVEY_PART(has_probe, GLINT_PART_PROBE)
SURVEY_PART(has_indirect, "indirect")
SURVEY_PART(has_planar, GLINT_PART_MIRROR)
SURVEY_PART(has_volume, "volume.000")
SURVEY_PART(has_water, GLINT_PART_WATER)
SURVEY_PART(has_transparent, GLINT_PART_TRANSPARENT)
