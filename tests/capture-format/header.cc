// The public headers in C++: describes a part and links against the C functions, as an engine does.
#include "glint/capture.h"
#include "glint/common.h"
#include "glint/exr.h"

int main(int argc, char **) {
    glint_error err{};
    glint_limits limits{};
    limits.width = 4096;
    glint_part part{};
    part.name = "lit";
    part.encodings.color = GLINT_COLOR_PRE_EXPOSED;
    glint_capture *capture = glint_capture_open("", &limits, argc > 1 ? nullptr : &err);
    const bool refused = !capture && err.code == GLINT_ERROR_IO && err.message[0];
    return refused && part.encodings.color == glint_encoding_value("color", "pre_exposed") ? 0 : 1;
}
