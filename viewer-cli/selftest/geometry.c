/* The group "geometry": rays that are hard on arithmetic, against closed forms and replays in double precision. */
#include "geometry.h"

TRIAL_GROUP(selftest_geometry, "geometry", "rays that are hard on arithmetic", &geometry_surfaces, &geometry_screen,
            &geometry_cubes, &geometry_hulls);
