/* compare_raw WIDTH HEIGHT FOUND TRUTH MAPS PPD EXPOSURE START STOP: compares two files of R G B floats, prints the metrics by name and
   writes the maps of FLIP and HDR-FLIP, for tests in other languages. */
#include <stdio.h>
#include <stdlib.h>

#include "glint/metrics.h"

static bool read_pixels(const char *path, struct glint_pixels *pixels) {
    size_t count = (size_t)pixels->width * pixels->height * 3;
    FILE *file = fopen(path, "rb");
    pixels->components = 3;
    pixels->values = malloc(count * sizeof *pixels->values);
    bool ok = file && pixels->values && fread(pixels->values, sizeof *pixels->values, count, file) == count;
    if (file) fclose(file);
    return ok;
}

static bool write_maps(const char *path, const struct glint_metric_table *table, size_t pixels) {
    FILE *file = fopen(path, "wb");
    bool ok = file && fwrite(table->flip, sizeof(float), pixels, file) == pixels &&
              fwrite(table->hdr_flip, sizeof(float), pixels, file) == pixels;
    if (file && fclose(file) != 0) ok = false;
    return ok;
}

int main(int argc, char **argv) {
    if (argc != 10) return 2;
    struct glint_pixels found = {.width = (uint32_t)atoi(argv[1]), .height = (uint32_t)atoi(argv[2])}, truth = found;
    struct glint_metric_options options = {.metrics = GLINT_METRICS_ALL,
                                           .ppd = atof(argv[6]),
                                           .exposure = atof(argv[7]),
                                           .start_exposure = atof(argv[8]),
                                           .stop_exposure = atof(argv[9])};
    struct glint_metric_table table;
    struct glint_error err = {0};
    if (!read_pixels(argv[3], &found) || !read_pixels(argv[4], &truth)) return 1;
    if (!glint_metrics_compare(&found, &truth, &options, &table, &err)) {
        fprintf(stderr, "%s\n", err.message);
        return 1;
    }
    for (size_t k = 0; k < GLINT_METRIC_COUNT; k++)
        printf("%s %.9g\n", glint_metric(k)->name, table.rows[0].of[k].value);
    printf("peak %.9g\nstart %.9g\nstop %.9g\nexposures %u\n", table.peak, table.start_exposure, table.stop_exposure,
           table.exposures);
    bool ok = write_maps(argv[5], &table, (size_t)found.width * found.height);
    glint_metric_table_finish(&table);
    glint_pixels_finish(&found);
    glint_pixels_finish(&truth);
    return ok ? 0 : 1;
}
