// The values of end_reasons.h. Its rows are the only list: the place in it is the value, counted by __LINE__.
#ifndef GLINT_END_REASONS
#define GLINT_END_REASONS
#define REASON(name, text) const uint END_##name = __LINE__ - 2;
#include "shared/end_reasons.h"
#undef REASON
#endif
