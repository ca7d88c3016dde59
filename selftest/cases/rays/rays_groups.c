/* The group "geometry": numerically difficult rays against closed forms and references in double precision. The group "sizes": very small, very
   large and odd pictures and cube maps. */
#include "cases/rays/rays_lists.h"

REPLAY_CASE_GROUP(geometry, "rays in numerically difficult directions", &geometry_surfaces, &geometry_screen,
                  &geometry_cubes, &geometry_hulls);
REPLAY_CASE_GROUP(sizes, "pictures and cube maps of any size", &sizes_screen, &sizes_cubes);
