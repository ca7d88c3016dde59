/* glint passes: prints the handbook of passes from their declarations. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "nearest.h"
#include "options/pass_json.h"
#include "options/pass_names.h"
#include "io/table.h"

struct arguments {
    bool json, markdown;
    const char *what;
};

static const struct argp_option options[] = {
    {"json", 'j', NULL, 0, "Print JSON", 0},
    {"markdown", 'm', NULL, 0, "Print the handbook as Markdown", 0},
    {0},
};
static const struct example examples[] = {
    {"glint passes", "lists all slots and variants by effect"},
    {"glint passes reflection", "prints all passes of an effect"},
    {"glint passes screen_trace", "prints images and parameters of all variants of a slot"},
    {"glint passes cubemap_trace/march", "prints one variant"},
    {"glint passes --markdown > passes.md", "writes the whole handbook"},
    {0},
};

static const struct arg_target targets[] = {
    STORED('j', struct arguments, json),
    STORED('m', struct arguments, markdown),
    {0},
};

static error_t cmd_passes_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_ARG:
        if (a->what) argp_error(state, "expected one effect, slot or variant, found %s and %s", a->what, arg);
        a->what = arg;
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

/* "reflection" takes every pass of the effect, "screen_trace" every variant of the slot, "screen_trace/linear" one pass, NULL all. */
static bool selected(const struct glint_pass *pass, const char *what) {
    if (!what || !strcmp(pass->effect, what)) return true;
    size_t slot = strcspn(what, "/");
    if (strlen(pass->slot) != slot || memcmp(pass->slot, what, slot) != 0) return false;
    return !what[slot] || !strcmp(pass->variant, what + slot + 1);
}

static void print_tables(struct table *table, bool markdown) {
    if (table_is_empty(table)) return;
    (markdown ? table_print_markdown : table_print)(table, stdout);
    putchar('\n');
}

static void print_inputs(const struct glint_pass *pass, bool markdown) {
    static const char *const titles[] = {"<reads", "<from", "<unit", "<meaning", NULL};
    struct table *table = table_create(titles);
    for (size_t i = 0; i < pass->row_count; i++) {
        if (pass->rows[i].kind != GLINT_ROW_READ) continue;
        const char *slot = "no pass";
        const struct glint_row *image = image_find(pass->rows[i].name, &slot);
        table_cell(table, "%s", pass->rows[i].name);
        table_cell(table, "%s", slot);
        table_cell(table, "%s", image ? image->unit : "");
        table_cell(table, "%s", image ? image->help : "");
    }
    print_tables(table, markdown);
    table_destroy(&table);
}

static void print_outputs(const struct glint_pass *pass, bool markdown) {
    static const char *const titles[] = {"<writes",   "<size", "<format",  "<channels",
                                         ">fallback", "<unit", "<meaning", NULL};
    struct table *table = table_create(titles);
    for (size_t i = 0; i < pass->row_count; i++) {
        const struct glint_row *row = &pass->rows[i];
        if (!glint_row_is_output(row)) continue;
        table_cell(table, "%s", row->name);
        table_cell(table, "%s", size_name(row->size));
        table_cell(table, "%s", format_name(row->format));
        table_cell(table, "%s", row->channels);
        table_cell(table, "%s", value_text(row, row->fallback));
        table_cell(table, "%s", row->unit);
        table_cell(table, "%s%s", row->help, row->kind == GLINT_ROW_DIAGNOSTIC ? " (with --diagnostics)" : "");
    }
    print_tables(table, markdown);
    table_destroy(&table);
}

/* The Markdown handbook has a column for everything; in the terminal, choices and source are appended to the help to save width. */
static void add_parameter(struct table *table, const struct glint_pass *pass, const struct glint_row *row,
                          bool markdown) {
    char *names = row->choices ? join_names("", row->choices) : NULL;
    const char *assumed = glint_pass_assumes(pass, row) ? " (assumed: captures do not contain it)" : "";
    if (markdown) table_cell(table, "%s.%s", pass->slot, row->name);
    else table_cell(table, "%s", row->name);
    if (markdown) table_cell(table, "%s", row_type(row));
    table_cell(table, "%s", value_text(row, row->initial));
    if (names) table_cell(table, "%s", markdown ? names : "");
    else if (row->type == GLINT_VALUE_BOOL) table_cell(table, "off, on");
    else table_cell(table, "%s … %s", value_text(row, row->lowest), value_text(row, row->highest));
    table_cell(table, "%s", strcmp(row->unit, "1") ? row->unit : "");
    if (markdown) {
        table_cell(table, "%s", row->source);
        table_cell(table, "%s%s", row->help, assumed);
    } else table_cell(table, "%s%s%s%s [%s]", names ? names : "", names ? ": " : "", row->help, assumed, row->source);
    free(names);
}

static void print_parameters(const struct glint_pass *pass, bool markdown) {
    static const char *const wide[] = {"<parameter", "<type", ">default", "<range", "<unit", "<source", "<help", NULL};
    static const char *const narrow[] = {"<parameter", ">default", "<range", "<unit", "<help [source]", NULL};
    struct table *table = table_create(markdown ? wide : narrow);
    const struct glint_row *last = NULL;
    for (size_t i = 0; i < pass->row_count; i++) {
        if (!glint_row_is_parameter(&pass->rows[i])) continue;
        if (!last && !markdown)
            printf("Parameters, as in --set %s.%s=%s:\n", pass->slot, pass->rows[i].name,
                   value_text(&pass->rows[i], pass->rows[i].initial));
        last = &pass->rows[i];
        add_parameter(table, pass, last, markdown);
    }
    print_tables(table, markdown);
    table_destroy(&table);
}

/* Prints the reference that `glint blame` uses for the slot. */
static void print_reference(const struct glint_pass *pass) {
    bool is = false;
    for (size_t i = 0; i < pass->row_count; i++) {
        const struct glint_row *row = &pass->rows[i];
        if (row->kind == GLINT_ROW_REFERENCE) fputs("The reference uses this variant", stdout), is = true;
        if (row->kind == GLINT_ROW_REFERENCE_NONE)
            printf("The reference leaves this slot out: %s", row->help), is = true;
    }
    for (size_t i = 0, first = 1; i < pass->row_count; i++) {
        const struct glint_row *row = &pass->rows[i];
        const bool own = row->kind == GLINT_ROW_REFERENCE_SET && !strcmp(row->image, pass->slot);
        if (row->kind != GLINT_ROW_REFERENCE_SET) continue;
        printf("%s%s%s%s=%s", first ? ", with " : ", ", own ? "" : row->image, own ? "" : ".", row->name,
               row->assigned);
        first = 0;
    }
    if (is) fputs(".\n", stdout);
    for (size_t i = 0; i < pass->row_count; i++)
        if (pass->rows[i].kind == GLINT_ROW_REFERENCE_WITH)
            printf("glint blame replaces it by its reference only together with %s: %s.\n", pass->rows[i].name,
                   pass->rows[i].help),
                is = true;
    if (is) fputs("\n", stdout);
}

/* Prints what the pass does without images that captures need not have. */
static void print_without(const struct glint_pass *pass, bool markdown) {
    bool any = false;
    for (size_t i = 0; i < pass->row_count; i++) {
        const struct glint_row *row = &pass->rows[i];
        if (row->kind != GLINT_ROW_WITHOUT) continue;
        printf(markdown ? "Without `%s`: %s.\n" : "Without %s: %s.\n", row->name, row->help);
        any = true;
    }
    if (any) putchar('\n');
}

static void print_pass(const struct glint_pass *pass, const char *previous_slot, bool markdown) {
    if (!previous_slot || strcmp(previous_slot, pass->slot) != 0)
        printf(markdown ? "### `%s`\n\n%s.\n\n" : "%s: %s\n\n", pass->slot, slot_title(pass));
    printf(markdown ? "#### `%s/%s`\n\n%s. Source: %s.\n\n" : "%s/%s: %s (source: %s)\n\n", pass->slot, pass->variant,
           pass->title, pass->source);
    bool any = false;
    for (size_t i = 0; i < pass->row_count; i++) {
        if (pass->rows[i].kind != GLINT_ROW_NEEDS) continue;
        printf("%s%s", any ? ", " : "Runs only if the survey finds: ", pass->rows[i].name);
        if (pass->rows[i].image) printf(" (limit: %s)", pass->rows[i].image);
        any = true;
    }
    for (size_t i = 0, first = 1; i < pass->row_count; i++) {
        if (pass->rows[i].kind != GLINT_ROW_CALLED_BY) continue;
        printf("%s%s (for %s)",
               !first ? " or "
               : any  ? ", and "
                      : "Runs only if the survey finds: ",
               pass->rows[i].name, pass->rows[i].image);
        any = true, first = 0;
    }
    for (size_t i = 0; i < pass->row_count; i++)
        if (pass->rows[i].kind == GLINT_ROW_ALIAS)
            printf("; otherwise %s is %s", pass->rows[i].image, pass->rows[i].name);
    if (any) fputs(markdown ? ".\n\n" : "\n\n", stdout);
    print_without(pass, markdown);
    print_reference(pass);
    print_inputs(pass, markdown);
    print_outputs(pass, markdown);
    print_parameters(pass, markdown);
}

/* The effect whose name follows `name` in the alphabet, NULL after the last one; NULL asks for the first. */
static const char *next_effect(const struct glint_pass *passes, size_t count, const char *name) {
    const char *next = NULL;
    for (size_t i = 0; i < count; i++)
        if ((!name || strcmp(passes[i].effect, name) > 0) && (!next || strcmp(passes[i].effect, next) < 0))
            next = passes[i].effect;
    return next;
}

/* The effects that are declared; other folders hold what they share. */
static void print_effects(void) {
    static const char *const titles[] = {"<effect", "<what it is", "<composed picture", NULL};
    struct table *table = table_create(titles);
    size_t count;
    const struct glint_effect *effects = glint_effects(&count);
    for (size_t e = 0; e < count; e++) {
        table_cell(table, "%s", effects[e].name);
        table_cell(table, "%s", effects[e].about);
        table_cell(table, "%s", effects[e].term);
    }
    putchar('\n');
    table_print(table, stdout);
    table_destroy(&table);
}

static void print_list(const struct glint_pass *passes, size_t count) {
    static const char *const titles[] = {"<effect", "<slot", "<variant", "<what it does", "<source", NULL};
    struct table *table = table_create(titles);
    for (const char *effect = NULL; (effect = next_effect(passes, count, effect));)
        for (size_t i = 0; i < count; i++) {
            if (strcmp(passes[i].effect, effect) != 0) continue;
            table_cell(table, "%s", effect);
            table_cell(table, "%s", passes[i].slot);
            table_cell(table, "%s", passes[i].variant);
            table_cell(table, "%s", passes[i].title);
            table_cell(table, "%s", passes[i].source);
        }
    table_print(table, stdout);
    table_destroy(&table);
    print_effects();
}

/* Its slots in the order in which they are listed. */
static void print_slots(const struct glint_effect *effect, const char *code) {
    size_t count;
    const struct glint_pass *passes = glint_passes(&count);
    const char *slot = NULL;
    for (size_t i = 0; i < count; i++) {
        if (strcmp(passes[i].effect, effect->name) != 0 || (slot && !strcmp(slot, passes[i].slot))) continue;
        printf("%s%s%s%s", slot ? ", " : "", code, passes[i].slot, code);
        slot = passes[i].slot;
    }
    if (effect->of_all) printf(", and those of all other effects");
}

/* What the effect's own declaration says. */
static void print_effect(const struct glint_effect *effect, bool markdown) {
    const char *item = markdown ? "- " : "", *code = markdown ? "`" : "";
    const size_t classes = glint_effect_class_count(effect);
    printf("%s\n\n%sresult: ", effect->about, item);
    for (size_t k = 0; k < GLINT_EFFECT_RESULTS && effect->results[k]; k++)
        printf("%s%s%s%s", k ? ", else " : "", code, effect->results[k], code);
    printf("\n%scomposed picture: %s\n", item, effect->term);
    if (effect->no_truth) printf("%struth: none, since %s\n", item, effect->no_truth);
    else
        printf("%struth: %s%s%s%s (%s)\n", item, code, effect->truth, effect->truth_has_choices ? ".*" : "", code,
               effect->channels);
    printf("%scalled for by: %s%s%s\n", item, code, effect->fact, code);
    static const char *const judged[] = {"pixels that reflect", "all pixels but sky", "all pixels"};
    printf("%sjudged in: %s", item, judged[effect->judged]);
    if (classes) printf(", in classes by %s%s %s%s: ", code, effect->class_part, effect->class_channel, code);
    for (size_t k = 0; k < classes; k++) {
        printf("%s%s", k ? ", " : "", effect->classes[k].name);
        if (isfinite(effect->classes[k].most)) printf(" up to %s", number_text(effect->classes[k].most));
    }
    printf("\n%sslots: ", item);
    print_slots(effect, code);
    puts("\n");
}

static void print_handbook(const struct glint_pass *passes, size_t count, const char *what, bool markdown) {
    for (const char *effect = NULL; (effect = next_effect(passes, count, effect));) {
        const char *slot = NULL;
        for (size_t i = 0; i < count; i++) {
            if (strcmp(passes[i].effect, effect) != 0 || !selected(&passes[i], what)) continue;
            const struct glint_effect *declared = glint_effect_find(effect);
            if (!slot && markdown) printf(declared ? "## Effect `%s`\n\n" : "## Shared: `%s`\n\n", effect);
            if (!slot && declared && (!what || !strcmp(what, effect))) print_effect(declared, markdown);
            print_pass(&passes[i], slot, markdown);
            slot = passes[i].slot;
        }
    }
}

static bool check_selection(const char *what, struct glint_error *err) {
    size_t slot = strcspn(what, "/"), count = 0;
    const struct glint_pass *passes = glint_passes(&count);
    for (size_t i = 0; i < count; i++)
        if (!strcmp(passes[i].effect, what)) return true;
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)slot, what);
    return what[slot] ? glint_variant_check(name, what + slot + 1, err) : glint_slot_check(name, err);
}

static const char introduction[] =
    "# Passes\n\nGenerated by `glint passes --markdown` from the declarations. The [glossary](glossary.md) explains "
    "the terms.\n\n"
    "- **Runs only if the survey finds**: the [facts](glossary.md#fact) without which a plan leaves the pass out.\n"
    "- **size**: `full` is the size of the picture and `half` that of the pipeline, which `downsample/none` makes "
    "full, too; `quarter` is half of that, and so on.\n"
    "- **fallback**: the value of the image where a texel has no result, and everywhere if the pass does not run.\n"
    "- **source**: the [document](sources.md) that a value comes from. *Not printed*: it has the parameter without a "
    "value.\n"
    "  *glint*: no document has it.\n\n";

static enum status cmd_passes_run(int argc, char **argv) {
    struct arguments a = {0};
    command_parse(&cmd_passes, argc, argv, &a);
    struct glint_error err = {0};
    if (a.what && !check_selection(a.what, &err)) return command_fail(&cmd_passes, &err);
    size_t count = 0;
    const struct glint_pass *passes = glint_passes(&count);
    if (a.json) {
        json_t *list = json_array();
        for (size_t i = 0; i < count; i++)
            if (selected(&passes[i], a.what)) json_array_append_new(list, pass_json(&passes[i]));
        json_t *effects = json_array();
        size_t effect_count;
        const struct glint_effect *effect = glint_effects(&effect_count);
        for (size_t e = 0; e < effect_count; e++)
            if (!a.what || !strcmp(a.what, effect[e].name)) json_array_append_new(effects, effect_json(&effect[e]));
        return print_json(json_pack("{s:o, s:o}", "effects", effects, "passes", list));
    }
    if (!a.what && !a.markdown) {
        print_list(passes, count);
        return STATUS_DONE;
    }
    if (a.markdown && !a.what) fputs(introduction, stdout);
    print_handbook(passes, count, a.what, a.markdown);
    return STATUS_DONE;
}

const struct command cmd_passes = {
    .name = "passes",
    .arguments = "[GROUP|SLOT[/VARIANT]]",
    .summary = "document the passes, their images and parameters",
    .description = "Lists all passes and effects. With an effect or another group of slots, a slot or a variant, "
                   "prints which images it reads and writes, with unit "
                   "and meaning, and its parameters with default, range, unit and source, as used by --set.",
    .options = options,
    .targets = targets,
    .parse = cmd_passes_parse,
    .examples = examples,
    .run = cmd_passes_run,
};
