/* Values that no image should hold: NaN, infinity where it is no distance, what lies beyond half. */
#ifndef GLINT_REPLAY_BAD_VALUES_H
#define GLINT_REPLAY_BAD_VALUES_H

#include "state.h"

#define HALF_LARGEST 65504.0f
/* Half's largest, with the sign, for what is finite and lies beyond it. */
float half_clamped(float value);

/* One more of an image's values, its number `index`, before it is stored. */
void bad_value(struct bad_values *found, const struct glint_row *row, bool half, size_t index, float value);
/* Of later values too. */
void bad_values_add(struct bad_values *found, const struct bad_values *more);
/* Of a level that the device made, read back into `texels`. */
struct image_part;
void bad_values_of_texels(const struct image_part *part, const void *texels);

/* What the capture's images of a run that has ended hold, kept with the results. */
bool bad_values_of_capture(struct run *run, struct glint_error *err);
json_t *bad_values_record(const struct glint_bad_values *list, size_t count);

#endif
