/* A device with validation and a tiny capture for the tests of replay. */
#ifndef GLINT_TEST_FIXTURE_H
#define GLINT_TEST_FIXTURE_H

#include "glint/replay.h"

struct fixture {
    char folder[64]; /* a temporary folder, which contains the capture */
    char capture_path[128];
    struct glint_device *device; /* NULL for tests without a device */
    struct glint_capture *capture;
    struct glint_pipeline *pipeline;
    struct glint_replay *replay;
};

enum {
    FIXTURE_WIDTH = 50,
    FIXTURE_HEIGHT = 31, /* odd, so that half sizes are rounded */
    FIXTURE_FACE = 8,
    FIXTURE_CUBEMAPS = 3
};

struct fixture_options {
    bool matte; /* nothing reflects */
    bool no_cubemaps;
    const struct glint_part *extra; /* additional parts, or NULL */
    size_t extra_count;
    uint32_t number; /* of the frame, 0: 7; frames have different depths */
    bool cut;
    const char *cubemaps; /* a file beside the capture with the cube maps, or NULL */
};
/* Writes the capture. False if the writer refuses it. */
bool fixture_write_capture(const char *path, const struct fixture_options *options, struct glint_error *err);

/* Writes a file with cube maps alone; `first` selects their colours. */
bool fixture_write_cubemaps(const char *path, int first, struct glint_error *err);

/* cmocka group fixtures: *state is a struct fixture. Without a Vulkan device the tests are skipped unless GLINT_REQUIRE_DEVICE=1; a
   device without the validation layer is a failure. */
int fixture_setup_device(void **state);
int fixture_setup_host(void **state);
int fixture_teardown(void **state);
/* Skips the calling test if there is no device. */
struct fixture *fixture_need_device(void **state);

/* Runs the fixture's pipeline, writes the last run to a folder beside the capture, or finds a result; fails the test on errors. */
void fixture_run(struct fixture *fixture, const struct glint_replay_options *options);
void fixture_write_run(struct fixture *fixture, const char *name, char path[128]);
const struct glint_pass_result *fixture_result(const struct fixture *fixture, const char *slot);
/* A progress callback that stops at the pass resolve. */
bool fixture_stop_at_resolve(void *user, const char *what, double done);
/* Fails the calling test unless the message contains `part`. */
void fixture_says(const struct glint_error *err, const char *part);

/* Fails the calling test if the validation layer reported anything. */
void fixture_check_messages(const struct fixture *fixture);

/* All images of the last run in their own types. */
struct snapshot {
    size_t count;
    struct {
        char name[64];
        size_t bytes;
        void *data;
        const char *slot;
    } images[64];
};
void snapshot_take(struct snapshot *snapshot, struct glint_replay *replay);
void snapshot_free(struct snapshot *snapshot);
/* Fails the calling test unless every image of `part` has the same bits in `whole`; returns the number of images. */
size_t snapshot_compare(const struct snapshot *part, const struct snapshot *whole);

#endif
