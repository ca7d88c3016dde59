/* glint devices: lists the Vulkan devices in the order of preference. */
#include "command.h"
#include "options/args.h"
#include "glint/replay.h"
#include "io/table.h"

static const struct argp_option options[] = {
    {"json", 'j', NULL, 0, "Print JSON", 0},
    {0},
};
static const struct example examples[] = {
    {"glint devices", "list the devices; the first usable one is the default"},
    {"GLINT_DEVICE=llvmpipe glint replay street.exr -o run", "choose one by a part of its name"},
    {0},
};

static error_t cmd_devices_parse(int key, char *arg, struct argp_state *state) {
    (void)arg;
    bool *json = state->input;
    switch (key) {
    case 'j':
        *json = true;
        return 0;
    case ARGP_KEY_ARG:
        argp_error(state, "unexpected argument %s", arg);
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

static json_t *device_json(const struct glint_device_info *d, size_t index) {
    return json_pack("{s:I, s:s, s:s, s:s, s:s, s:b, s:b, s:s, s:s, s:I}", "index", (json_int_t)index, "name", d->name,
                     "type", d->type, "driver", d->driver, "driver_version", d->driver_version, "cpu", d->is_cpu,
                     "usable", d->usable, "reason", d->reason, "api", "", "memory_bytes", (json_int_t)d->memory_bytes);
}

static void version_text(uint32_t version, char text[32]) {
    snprintf(text, 32, "%u.%u.%u", version >> 22 & 0x7f, version >> 12 & 0x3ff, version & 0xfff);
}

static enum status print_devices_json(const struct glint_device_info *devices, size_t count) {
    json_t *list = json_array();
    for (size_t i = 0; i < count; i++) {
        char api[32];
        version_text(devices[i].api_version, api);
        json_t *device = device_json(&devices[i], i);
        json_object_set_new(device, "api", json_string(api));
        json_array_append_new(list, device);
    }
    return print_json(json_pack("{s:o}", "devices", list));
}

static void print_devices_table(const struct glint_device_info *devices, size_t count) {
    static const char *const titles[] = {">index", "<name", "<type", "<driver", "<Vulkan", ">memory", "<usable", NULL};
    struct table *table = table_create(titles);
    for (size_t i = 0; i < count; i++) {
        const struct glint_device_info *d = &devices[i];
        char api[32];
        version_text(d->api_version, api);
        table_cell(table, "%zu", i);
        table_cell(table, "%s", d->name);
        table_cell(table, "%s", d->type);
        table_cell(table, "%s %s", d->driver, d->driver_version);
        table_cell(table, "%s", api);
        table_cell(table, "%s", bytes_text(d->memory_bytes));
        table_cell(table, "%s%s", d->usable ? "yes" : "no: ", d->usable ? "" : d->reason);
    }
    table_print(table, stdout);
    table_destroy(&table);
}

static enum status cmd_devices_run(int argc, char **argv) {
    bool json = false;
    command_parse(&cmd_devices, argc, argv, &json);
    struct glint_device_info devices[16];
    struct glint_error err = {0};
    size_t count = glint_devices(devices, 16, &err);
    if (count > 16) count = 16;
    if (count == 0 && err.code != GLINT_OK) return command_fail(&cmd_devices, &err);
    bool usable = false;
    for (size_t i = 0; i < count; i++) usable = usable || devices[i].usable;
    enum status status = STATUS_DONE;
    if (json) status = print_devices_json(devices, count);
    else if (count) print_devices_table(devices, count);
    if (!usable) command_note(&cmd_devices, "no usable Vulkan device (Debian: apt install mesa-vulkan-drivers)");
    return usable ? status : STATUS_CHECK;
}

const struct command cmd_devices = {
    .name = "devices",
    .arguments = "",
    .summary = "list the Vulkan devices",
    .description =
        "Lists the Vulkan devices in the order of preference: discrete, integrated, virtual, CPU. The first usable "
        "one is the default unless GLINT_DEVICE names another.",
    .options = options,
    .parse = cmd_devices_parse,
    .examples = examples,
    .run = cmd_devices_run,
};
