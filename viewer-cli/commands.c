/* The list of commands. A new one is added here, to command.h and to meson.build, with its own cmd_NAME.c. */
#include "command.h"

#include <string.h>

/* clang-format off */
const struct command *const commands[] = {
    &cmd_sample,
    &cmd_pack,
    &cmd_extract,
    &cmd_info,
    &cmd_validate,
    &cmd_lint,
    &cmd_set,
    &cmd_crop,
    &cmd_strip,
    &cmd_plan,
    &cmd_replay,
    &cmd_live,
    &cmd_reference,
    &cmd_compare,
    &cmd_sweep,
    &cmd_merge,
    &cmd_batch,
    &cmd_blame,
    &cmd_tune,
    &cmd_stability,
    &cmd_probe,
    &cmd_explain,
    &cmd_diff,
    &cmd_check,
    &cmd_view,
    &cmd_report,
    &cmd_export,
    &cmd_selftest,
    &cmd_passes,
    &cmd_devices,
};
/* clang-format on */
const size_t command_count = sizeof commands / sizeof *commands;

const struct command *command_find(const char *name) {
    for (size_t i = 0; i < command_count; i++)
        if (!strcmp(commands[i]->name, name)) return commands[i];
    return NULL;
}
