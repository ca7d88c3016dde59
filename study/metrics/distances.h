/* What tables of rays share with the errors of distances. */
#ifndef GLINT_STUDY_DISTANCES_H
#define GLINT_STUDY_DISTANCES_H

/* |found - truth|/truth; 0 where both are infinite, infinite where one is or `found` is no distance. */
double distance_relative_error(double found, double truth);

#endif
