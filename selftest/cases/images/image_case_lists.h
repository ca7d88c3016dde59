/* The lists of image cases, the second part of the group "functions". */
#ifndef GLINT_SELFTEST_IMAGE_CASE_LISTS_H
#define GLINT_SELFTEST_IMAGE_CASE_LISTS_H

#include "harness/image_case.h"

extern const struct image_list images_surfaces, images_lists, images_cubes, images_planes, images_shown, decodings;

#endif
