// The values of end_reasons.h, whose rows are the only list: a reason's value is the number of its line.
#ifndef GLINT_END_REASONS
#define GLINT_END_REASONS
#define REASON(name, text) const uint END_##name = __LINE__ - 2;
#include "shared/end_reasons.h"
#undef REASON
#endif
