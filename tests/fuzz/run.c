/* Fuzzes what reads run folders: the input is run.json; the images that it may name are there. */
#include <stdlib.h>

#include "fuzz.h"
#include "glint/exr.h"
#include "glint/replay.h"

enum { WIDTH = 4, HEIGHT = 24 };

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerInitialize(int *argc, char ***argv) {
    static float values[WIDTH * HEIGHT];
    const struct glint_exr_channel channels[] = {
        {"A", GLINT_STORED_FLOAT, values, 0, 0}, {"B", GLINT_STORED_FLOAT, values, 0, 0},
        {"G", GLINT_STORED_FLOAT, values, 0, 0}, {"R", GLINT_STORED_FLOAT, values, 0, 0},
        {"X", GLINT_STORED_UINT, values, 0, 0},  {"Z", GLINT_STORED_FLOAT, values, 0, 0}};
    const size_t count = sizeof channels / sizeof *channels;
    const struct glint_exr_part parts[] = {
        {.name = "a", .width = WIDTH, .height = HEIGHT, .channels = channels, .channel_count = count},
        {.name = "b", .width = WIDTH, .height = 3, .channels = channels, .channel_count = count}};
    struct glint_error err = {0};
    (void)argc, (void)argv;
    fuzz_must(glint_exr_write(fuzz_file("images.exr", "", 0), parts, 2, 1, &err), err.message);
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct glint_error err = {0};
    fuzz_file("run.json", data, size);
    struct glint_run *run = glint_run_open(fuzz_folder(), &err);
    if (!fuzz_reason(run != NULL, &err)) return 0;
    for (size_t i = 0; i < glint_run_image_count(run); i++) {
        const struct glint_run_image *image = glint_run_image(run, i);
        fuzz_must(glint_run_find(run, image->name) != NULL, "an image is found by its name");
        fuzz_must(image->components >= 1 && image->components <= 4, "an image has 1 to 4 channels");
        if (image->width > WIDTH || image->height > HEIGHT) continue; /* none is there */
        float values[WIDTH * HEIGHT * 4];
        fuzz_reason(image->integer ? glint_run_read(run, image, GLINT_U32, values, &err)
                                   : glint_run_read_linear(run, image, values, &err),
                    &err);
    }
    glint_run_close(&run);
    return 0;
}
