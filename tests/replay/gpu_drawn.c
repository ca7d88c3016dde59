/* Plans change no bit on random captures: gpu_drawn [COUNT [FIRST SEED]]. Each is replayed with one preset in turn; a seed that fails
   is printed. */
#include <stdio.h>
#include <stdlib.h>

#include "drawn.h"
#include "pair.h"
#include "unit.h"

static uint32_t count = 6,
                first = 6; /* two of these six once revealed lookups that depended on neighbouring invocations */

/* Seeds of small captures that once revealed that a cube map's colour was divided by its opacity only in frames that show sky. They are
   replayed besides the default seeds, not with those of the command line. */
static const uint32_t found_before[] = {65, 115};
static size_t found_count = sizeof found_before / sizeof *found_before;

static size_t preset_count(void) {
    size_t count = 0;
    while (glint_preset(count)) count++;
    return count;
}

/* Most store floats, because halves round most differences off. */
static bool stores_halves(uint32_t seed) {
    return seed / preset_count() % 4 == 3;
}

static size_t differences(struct pair *pair, uint32_t seed) {
    const char *preset = glint_preset(seed % preset_count());
    size_t left_out = 0, differ = 0;
    struct glint_error err = {0};
    char path[256], says[160];
    pair_use(pair, preset);
    pair->float_precision = !stores_halves(seed);
    for (uint32_t frame = 1; frame <= DRAWN_FRAMES; frame++) {
        snprintf(path, sizeof path, "%s/drawn.exr", pair->fixture->folder);
        pair_check(drawn_write(path, seed, frame, says, &err), &err);
        struct glint_capture *capture = glint_capture_open(path, NULL, &err);
        pair_check(capture != NULL, &err);
        differ += pair_differences(pair, capture, &left_out);
        pair_check(glint_replay_load(pair->planned, NULL, &err) && glint_replay_load(pair->whole, NULL, &err), &err);
        glint_capture_close(&capture);
    }
    if (differ)
        print_error("seed %u, preset %s, %s: %zu values differ (%s)\n", seed, preset,
                    pair->float_precision ? "floats" : "halves", differ, says);
    pair->float_precision = false;
    return differ;
}

/* Catches: whatever a plan skips that is read, and arithmetic that depends on neighbouring invocations. Seeds with the same preset and
   precision are consecutive, so that few programs are compiled. */
static void plans_of_drawn_captures_change_no_bit(void **state) {
    struct pair *pair = pair_of(state);
    const size_t presets = preset_count();
    uint32_t faults = 0;
    for (size_t turn = 0; turn < 2 * presets; turn++)
        for (uint32_t seed = first; seed < first + count; seed++)
            if (seed % presets == turn / 2 && stores_halves(seed) == turn % 2) faults += differences(pair, seed) > 0;
    for (size_t i = 0; i < found_count; i++) faults += differences(pair, found_before[i]) > 0;
    if (faults)
        fail_msg("%u of %zu captures differ; to see one again: gpu_drawn 1 SEED", faults, (size_t)count + found_count);
    fixture_check_messages(pair->fixture);
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(plans_of_drawn_captures_change_no_bit)};
    if (argc > 1) count = (uint32_t)strtoul(argv[1], NULL, 10), found_count = 0;
    if (argc > 2) first = (uint32_t)strtoul(argv[2], NULL, 10);
    return cmocka_run_group_tests(tests, pair_set_up, pair_tear_down);
}
