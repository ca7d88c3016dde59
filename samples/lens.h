/* What an engine lays over its finished picture: a table of colours, dirt on the lens. */
#ifndef SAMPLES_LENS_H
#define SAMPLES_LENS_H

#include "dump.h"

/* Writes the parts that the options ask for. */
bool lens_write(const struct dump *dump, const struct glint_sample_options *options, struct glint_error *err);

#endif
