/* The group "sizes": pictures and cube maps as small and as large as any, and odd ones. */
#include "sizes.h"

TRIAL_GROUP(selftest_sizes, "sizes", "pictures and cube maps of any size", &sizes_screen, &sizes_cubes);
