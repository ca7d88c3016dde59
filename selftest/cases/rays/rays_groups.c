/* The groups "geometry", rays that are hard on arithmetic against closed forms and references in double precision, and "sizes",
   pictures and cube maps as small and as large as any, and odd ones. */
#include "cases/groups.h"
#include "cases/rays/rays_lists.h"

REPLAY_CASE_GROUP(geometry, "rays that are hard on arithmetic", &geometry_surfaces, &geometry_screen, &geometry_cubes,
                  &geometry_hulls);
REPLAY_CASE_GROUP(sizes, "pictures and cube maps of any size", &sizes_screen, &sizes_cubes);
