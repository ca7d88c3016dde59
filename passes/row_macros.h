/* What the generated readings of declarations (names.h, rows.h) are written with. */
#define PASTE2_(a, b) a##_##b
#define PASTE2(a, b) PASTE2_(a, b)
#define PASTE4_(a, b, c, d) a##_##b##_##c##_##d
#define PASTE4(a, b, c, d) PASTE4_(a, b, c, d)
/* The constant that is the number of a choice. */
#define PLACE(parameter, choice) PASTE4(place, PASS_ID, parameter, choice)

/* The type of a parameter, by its name in GLSL. */
#define VALUE_int GLINT_VALUE_INT
#define VALUE_uint GLINT_VALUE_UINT
#define VALUE_float GLINT_VALUE_FLOAT
#define VALUE_bool GLINT_VALUE_BOOL
