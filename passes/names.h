/* The host's first reading of declarations: names the title and numbers the choices, so that the second can use both as
   constants. Included by the generated pass table, which defines PASS_ID around each declaration. */
#define PASTE2_(a, b) a##_##b
#define PASTE2(a, b) PASTE2_(a, b)
#define PASTE4_(a, b, c, d) a##_##b##_##c##_##d
#define PASTE4(a, b, c, d) PASTE4_(a, b, c, d)
#define PLACE(parameter, choice) PASTE4(place, PASS_ID, parameter, choice)

#define PASS(text, from) static const char PASTE2(title, PASS_ID)[] = text, PASTE2(source, PASS_ID)[] = from;
#define SLOT(title)
#define READ(kind, image)
#define OPTIONAL_READ(kind, image, format, size, nothing)
#define SELF(kind, name, image)
#define HISTORY(kind, name, image)
#define WRITE(kind, image, format, unit, size, channels, nothing, text)
#define DIAGNOSTIC(kind, image, format, unit, size, channels, nothing, text)
#define SPEC(type, parameter, initial, lowest, highest, unit, source, text)
#define PUSH(type, parameter, initial, lowest, highest, unit, source, text)
#define CHOICE2(parameter, initial, a, b, source, text) enum { PLACE(parameter, a), PLACE(parameter, b) };
#define CHOICE3(parameter, initial, a, b, c, source, text) \
    enum { PLACE(parameter, a), PLACE(parameter, b), PLACE(parameter, c) };
#define CHOICE4(parameter, initial, a, b, c, d, source, text) \
    enum { PLACE(parameter, a), PLACE(parameter, b), PLACE(parameter, c), PLACE(parameter, d) };
#define DISPATCH(image)
#define DISPATCH_LEVELS(image, first, last, order)
#define DISPATCH_LEVELS_BY(image, width, first, last, order)
#define DISPATCH_LIST(list)
#define DISPATCH_TILES(range)
#define DISPATCH_TILES_BY(range, parameter)
#define WORKGROUP(width, height)
#define BLOCKS(across)
#define FACT(fact)
#define PER_RAY
#define ACCUMULATE(image)
#define NEEDS(fact)
#define NEEDS_BY(fact, parameter)
#define READS_LEVELS(image, parameter)
#define PASSES_ON(image, from)
#define INSTEAD(image, captured)
#define SHOWS_ALL(parameter)
#define ASSUMED(parameter)
#define ALONG_RAYS(image, normals)
#define WITHIN(texels)
#define RESOLUTION(size)
#define REFERENCE
#define REFERENCE_NONE(why)
#define REFERENCE_SET(slot, parameter, value)
#define REFERENCE_WITH(slot, why)
#define ROLE(role, name)
