/* The host's second reading of declarations: each row becomes one struct glint_row. Included by the generated pass
   table after names.h, whose names it uses. */
#undef PASS
#undef SLOT
#undef READ
#undef OPTIONAL_READ
#undef SELF
#undef HISTORY
#undef WRITE
#undef DIAGNOSTIC
#undef SPEC
#undef PUSH
#undef CHOICE2
#undef CHOICE3
#undef CHOICE4
#undef DISPATCH
#undef DISPATCH_LEVELS
#undef DISPATCH_LEVELS_BY
#undef DISPATCH_LIST
#undef DISPATCH_TILES
#undef DISPATCH_TILES_BY
#undef WORKGROUP
#undef BLOCKS
#undef FACT
#undef PER_RAY
#undef ACCUMULATE
#undef NEEDS
#undef NEEDS_BY
#undef READS_LEVELS
#undef PASSES_ON
#undef INSTEAD
#undef SHOWS_ALL
#undef ASSUMED
#undef ALONG_RAYS
#undef WITHIN
#undef RESOLUTION
#undef ROLE
#undef REFERENCE
#undef REFERENCE_NONE
#undef REFERENCE_SET
#undef REFERENCE_WITH
#define ROW_IMAGE(row, glsl_kind, image, fmt, image_unit, image_size, image_channels, none, text)            \
    {.kind = row, .id = __LINE__, .name = #image, .glsl = #glsl_kind, .format = GLINT_FORMAT_##fmt,          \
     .size = GLINT_SIZE_##image_size, .unit = image_unit, .channels = image_channels, .nothing = (double)(none), .help = text},
#define ROW_VALUE(row, cast, parameter, first, low, high, value_unit, from, text)                            \
    {.kind = row, .id = __LINE__, .name = #parameter, .type = VALUE_##cast, .initial = (double)(first),      \
     .lowest = (double)(low), .highest = (double)(high), .unit = value_unit, .source = from, .help = text},
#define ROW_CHOICE(parameter, first, last, from, text, ...)                                                  \
    {.kind = GLINT_ROW_CHOICE, .id = __LINE__, .name = #parameter, .type = GLINT_VALUE_INT,                  \
     .initial = PLACE(parameter, first), .lowest = 0, .highest = last, .unit = "1", .source = from, .help = text,                             \
     .choices = (const char *const[]){__VA_ARGS__, NULL}},
#define VALUE_int GLINT_VALUE_INT
#define VALUE_uint GLINT_VALUE_UINT
#define VALUE_float GLINT_VALUE_FLOAT
#define VALUE__Bool GLINT_VALUE_BOOL /* <stdbool.h> makes bool a macro */

#define PASS(title, from) {.kind = GLINT_ROW_PASS, .id = __LINE__, .name = title, .source = from},
#define SLOT(title) {.kind = GLINT_ROW_SLOT, .id = __LINE__, .name = title},
#define READ(kind_, image) {.kind = GLINT_ROW_READ, .id = __LINE__, .name = #image, .glsl = #kind_},
#define OPTIONAL_READ(kind_, image_, fmt, size_, none)                                                       \
    {.kind = GLINT_ROW_READ, .id = __LINE__, .name = #image_, .glsl = #kind_, .optional = true,              \
     .format = GLINT_FORMAT_##fmt, .size = GLINT_SIZE_##size_, .nothing = (double)(none)},
#define SELF(kind_, name_, image_) \
    {.kind = GLINT_ROW_SELF, .id = __LINE__, .name = #name_, .image = #image_, .glsl = #kind_},
#define HISTORY(kind_, name_, image_) \
    {.kind = GLINT_ROW_HISTORY, .id = __LINE__, .name = #name_, .image = #image_, .glsl = #kind_},
#define WRITE(kind_, image, fmt, unit_, size_, channels_, none, text) \
    ROW_IMAGE(GLINT_ROW_WRITE, kind_, image, fmt, unit_, size_, channels_, none, text)
#define DIAGNOSTIC(kind_, image, fmt, unit_, size_, channels_, none, text) \
    ROW_IMAGE(GLINT_ROW_DIAGNOSTIC, kind_, image, fmt, unit_, size_, channels_, none, text)
#define CAPTURE(image, fmt, unit_, size_, role_, from, must, none, text)                                     \
    {.kind = GLINT_ROW_CAPTURE, .id = __LINE__, .name = #image, .format = GLINT_FORMAT_##fmt,                \
     .size = GLINT_SIZE_##size_, .unit = unit_, .role = role_, .source = from, .required = must,             \
     .nothing = (double)(none), .help = text},
#define SPEC(type_, parameter, first, low, high, unit_, from, text) \
    ROW_VALUE(GLINT_ROW_SPEC, type_, parameter, first, low, high, unit_, from, text)
#define PUSH(type_, parameter, first, low, high, unit_, from, text) \
    ROW_VALUE(GLINT_ROW_PUSH, type_, parameter, first, low, high, unit_, from, text)
#define CHOICE2(parameter, first, a, b, from, text) ROW_CHOICE(parameter, first, 1, from, text, #a, #b)
#define CHOICE3(parameter, first, a, b, c, from, text) ROW_CHOICE(parameter, first, 2, from, text, #a, #b, #c)
#define CHOICE4(parameter, first, a, b, c, d, from, text) ROW_CHOICE(parameter, first, 3, from, text, #a, #b, #c, #d)
#define DISPATCH(image) {.kind = GLINT_ROW_DISPATCH, .id = __LINE__, .name = #image},
#define DISPATCH_LEVELS(image_, first_, last_, order_)                                                       \
    {.kind = GLINT_ROW_DISPATCH_LEVELS, .id = __LINE__, .name = #image_, .first = first_, .last = last_,      \
     .order = GLINT_ORDER_##order_},
#define DISPATCH_LEVELS_BY(image_, width_, first_, last_, order_)                                             \
    {.kind = GLINT_ROW_DISPATCH_LEVELS, .id = __LINE__, .name = #image_, .assigned = #width_, .first = first_,   \
     .last = last_, .order = GLINT_ORDER_##order_},
#define DISPATCH_LIST(list) {.kind = GLINT_ROW_DISPATCH_LIST, .id = __LINE__, .name = #list},
#define DISPATCH_TILES(range) {.kind = GLINT_ROW_DISPATCH_TILES, .id = __LINE__, .name = #range},
#define DISPATCH_TILES_BY(range, parameter) \
    {.kind = GLINT_ROW_DISPATCH_TILES, .id = __LINE__, .name = #range, .image = #parameter},
#define WORKGROUP(width, height) {.kind = GLINT_ROW_WORKGROUP, .id = __LINE__, .name = "", .first = width, .last = height},
#define BLOCKS(across) {.kind = GLINT_ROW_BLOCKS, .id = __LINE__, .name = "", .first = across},
#define FACT(fact) {.kind = GLINT_ROW_FACT, .id = __LINE__, .name = #fact},
#define PER_RAY {.kind = GLINT_ROW_PER_RAY, .id = __LINE__, .name = ""},
#define ACCUMULATE(image) {.kind = GLINT_ROW_ACCUMULATE, .id = __LINE__, .name = #image},
#define NEEDS(fact) {.kind = GLINT_ROW_NEEDS, .id = __LINE__, .name = #fact},
#define NEEDS_BY(fact, parameter) {.kind = GLINT_ROW_NEEDS, .id = __LINE__, .name = #fact, .image = #parameter},
#define READS_LEVELS(image_, parameter) \
    {.kind = GLINT_ROW_READS_LEVELS, .id = __LINE__, .name = #parameter, .image = #image_},
#define PASSES_ON(image_, from) {.kind = GLINT_ROW_PASSES_ON, .id = __LINE__, .name = #from, .image = #image_},
#define INSTEAD(image_, captured) {.kind = GLINT_ROW_INSTEAD, .id = __LINE__, .name = #captured, .image = #image_},
#define SHOWS_ALL(parameter) {.kind = GLINT_ROW_SHOWS_ALL, .id = __LINE__, .name = #parameter},
#define ALONG_RAYS(image_, normals) {.kind = GLINT_ROW_ALONG_RAYS, .id = __LINE__, .name = #image_, .image = #normals},
#define WITHIN(texels) {.kind = GLINT_ROW_WITHIN, .id = __LINE__, .name = "", .first = texels},
#define ASSUMED(parameter) {.kind = GLINT_ROW_ASSUMED, .id = __LINE__, .name = #parameter},
#define RESOLUTION(size) {.kind = GLINT_ROW_RESOLUTION, .id = __LINE__, .name = #size},
#define ROLE(role, name_) {.kind = GLINT_ROW_ROLE, .id = __LINE__, .name = "", .image = #name_, .first = GLINT_ROLE_##role},
#define REFERENCE {.kind = GLINT_ROW_REFERENCE, .id = __LINE__, .name = ""},
#define REFERENCE_NONE(why) {.kind = GLINT_ROW_REFERENCE_NONE, .id = __LINE__, .name = "", .help = why},
#define REFERENCE_SET(slot_, parameter, value)                                                                \
    {.kind = GLINT_ROW_REFERENCE_SET, .id = __LINE__, .name = #parameter, .image = #slot_, .assigned = #value},
#define REFERENCE_WITH(slot_, why) {.kind = GLINT_ROW_REFERENCE_WITH, .id = __LINE__, .name = #slot_, .help = why},
