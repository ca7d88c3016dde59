// Next include of a declaration: its PUSH rows become the push-constant block; close it with "};".
// It opens with a member of our own: the level that this dispatch writes.
#undef READ
#undef OPTIONAL_READ
#undef SELF
#undef HISTORY
#undef WRITE
#undef DIAGNOSTIC
#undef SPEC
#undef CHOICE2
#undef CHOICE3
#undef CHOICE4
#undef CHOICE5
#undef PUSH
#undef FACT
#undef BLOCKS
#define READ(kind, name)
#define OPTIONAL_READ(kind, name, format, size, nothing)
#define SELF(kind, name, image)
#define HISTORY(kind, name, image)
#define WRITE(kind, name, format, unit, size, channels, nothing, meaning)
#define DIAGNOSTIC(kind, name, format, unit, size, channels, nothing, meaning)
#define SPEC(type, name, initial, lowest, highest, unit, source, help)
#define CHOICE2(name, initial, a, b, source, help)
#define CHOICE3(name, initial, a, b, c, source, help)
#define CHOICE4(name, initial, a, b, c, d, source, help)
#define CHOICE5(name, initial, a, b, c, d, e, source, help)
#define FACT(fact)
#define BLOCKS(across)
#define PUSH(type, name, initial, lowest, highest, unit, source, help) type name;
layout(push_constant, std430) uniform Parameters {
    uint dispatch_level;
