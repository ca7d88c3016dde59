// Next include of a declaration: its images become bindings, its SPEC and CHOICE rows specialization constants.
// A row's line number is its binding or constant id. Written images have no format here, so that the host may store
// them as half or float without a compile.
layout(constant_id = 0) const bool diagnostics = false;
#define PASS(title, source)
#define SLOT(title)
#define READ(kind, name) layout(set = 0, binding = __LINE__) uniform kind name;
#define WRITE(kind, name, format, unit, size, channels, nothing, meaning) \
    layout(set = 0, binding = __LINE__) uniform writeonly kind name;
#define DIAGNOSTIC(kind, name, format, unit, size, channels, nothing, meaning) \
    layout(set = 0, binding = __LINE__) uniform writeonly kind name;
#define SPEC(type, name, initial, lowest, highest, unit, source, help) \
    layout(constant_id = __LINE__) const type name = type(initial);
#define CHOICE2(name, initial, a, b, source, help) \
    const int name##_##a = 0; const int name##_##b = 1; \
    layout(constant_id = __LINE__) const int name = name##_##initial;
#define CHOICE3(name, initial, a, b, c, source, help) \
    const int name##_##a = 0; const int name##_##b = 1; const int name##_##c = 2; \
    layout(constant_id = __LINE__) const int name = name##_##initial;
#define CHOICE4(name, initial, a, b, c, d, source, help) \
    const int name##_##a = 0; const int name##_##b = 1; const int name##_##c = 2; const int name##_##d = 3; \
    layout(constant_id = __LINE__) const int name = name##_##initial;
#define PUSH(type, name, initial, lowest, highest, unit, source, help)
#define DISPATCH(image)
#define NEEDS(fact)

layout(local_size_x = 8, local_size_y = 8) in;

#define FIELD(type, name, meaning) type name;
layout(set = 1, binding = 0, std140) uniform Frame {
#include "frame_fields.h"
} frame;
#undef FIELD
layout(set = 1, binding = 1) uniform sampler linear_clamp;
layout(set = 1, binding = 2) uniform sampler nearest_clamp;
