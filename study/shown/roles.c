/* Images of the last run by what they are to studies. */
#include "roles.h"

const struct glint_image *study_image(const struct glint_replay *replay, enum glint_pass_role role) {
    size_t count;
    const struct glint_pass_result *results = glint_replay_results(replay, &count);
    const struct glint_image *last = NULL;
    for (size_t i = 0; i < count; i++) {
        const struct glint_row *row = glint_pass_role(results[i].pass, role);
        const struct glint_image *image = row ? glint_replay_find_image(replay, row->image) : NULL;
        if (image) last = image;
    }
    return last;
}
