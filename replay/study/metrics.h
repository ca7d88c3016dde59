/* What tables of rays share with the metrics. */
#ifndef GLINT_STUDY_METRICS_H
#define GLINT_STUDY_METRICS_H

/* |found - truth|/truth; 0 where both are infinite, infinite where one is or `found` is no distance. */
double distance_relative_error(double found, double truth);

#endif
