/* The values of end reasons, as the diagnostics hold them. */
#ifndef GLINT_SELFTEST_END_REASON_NAMES_H
#define GLINT_SELFTEST_END_REASON_NAMES_H

#include <stdint.h>

enum {
#define REASON(name, ...) END_##name,
#include "shared/end_reasons.h"
#undef REASON
};

static inline const char *end_reason_name(uint32_t reason) {
    static const char *const names[] = {
#define REASON(name, ...) #name,
#include "shared/end_reasons.h"
#undef REASON
    };
    return reason < sizeof names / sizeof *names ? names[reason] : "unknown";
}

#endif
