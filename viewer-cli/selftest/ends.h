/* The values of end reasons, as the diagnostics hold them. */
#ifndef GLINT_VIEWER_ENDS_H
#define GLINT_VIEWER_ENDS_H

#include <stdint.h>

enum {
#define REASON(name, ...) END_##name,
#include "../../passes/shared/end_reasons.h"
#undef REASON
};

static inline const char *end_name(uint32_t reason) {
    static const char *const names[] = {
#define REASON(name, ...) #name,
#include "../../passes/shared/end_reasons.h"
#undef REASON
    };
    return reason < sizeof names / sizeof *names ? names[reason] : "unknown";
}

#endif
