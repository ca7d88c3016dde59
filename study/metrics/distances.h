/* The error of a distance. */
#ifndef GLINT_STUDY_DISTANCES_H
#define GLINT_STUDY_DISTANCES_H

/* |found - truth|/truth; 0 if both are infinite, infinite if one is or if `found` is NaN or negative. */
double distance_relative_error(double found, double truth);

#endif
