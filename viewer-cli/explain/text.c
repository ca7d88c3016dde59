/* What was found about a pixel, in sentences. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "explain/explain.h"
#include "io/table.h"
#include "options/args.h"

struct sentence {
    char text[900];
    size_t used;
};

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
say(struct sentence *s, const char *format, ...) {
    va_list values;
    va_start(values, format);
    const int length = vsnprintf(s->text + s->used, sizeof s->text - s->used, format, values);
    va_end(values);
    if (length > 0)
        s->used += (size_t)length < sizeof s->text - s->used ? (size_t)length : sizeof s->text - 1 - s->used;
}

static void finish(json_t *sentences, struct sentence *s) {
    if (s->used) json_array_append_new(sentences, json_string(s->text));
    *s = (struct sentence){.used = 0};
}

static void say_color(struct sentence *s, const double *rgb) {
    say(s, "%s %s %s", number_text(rgb[0]), number_text(rgb[1]), number_text(rgb[2]));
}

/* ---- The surface ---- */

/* The class of a surface, by the effect that classes by roughness. */
static const char *roughness_name(double roughness) {
    size_t count;
    const struct glint_effect *effects = glint_effects(&count);
    for (size_t e = 0; e < count; e++)
        if (!strcmp(effects[e].class_channel, "material.roughness"))
            return glint_effect_class_name(&effects[e], glint_effect_class_of(&effects[e], roughness));
    return "opaque";
}

static void describe_surface(const struct explain *e, json_t *sentences) {
    struct sentence s = {.used = 0};
    const uint32_t *at = e->probe.pixel;
    const double depth = explain_channel(&e->probe.own, "Z"), roughness = explain_channel(&e->probe.own, "roughness");
    const struct glint_probe_record *weight = explain_record(&e->probe.own, NULL, "reflectance", true), *end;
    if (depth == INFINITY) say(&s, "Pixel %u,%u shows the sky, which reflects nothing.", at[0], at[1]);
    else {
        say(&s, "Pixel %u,%u is a %s surface", at[0], at[1],
            isnan(roughness) ? "reflecting" : roughness_name(roughness));
        if (!isnan(roughness)) say(&s, " (roughness %s)", number_text(roughness));
        if (isfinite(depth)) say(&s, " at a depth of %s m", number_text(depth));
        if (!explain_last_tracer(&e->probe.own, &end))
            say(&s, ", for which no ray was traced: it has no specular reflection, or the pipeline leaves it out");
        else if (weight)
            say(&s, "; %.2g %% of what its ray brings reaches the camera",
                100 * (double)glint_probe_value(weight, "g"));
        say(&s, ".");
    }
    finish(sentences, &s);
}

/* ---- The ray ---- */

static bool is_step(const struct glint_probe_record *record, bool texels_only) {
    return glint_probe_is(record, "screen_texel") || glint_probe_is(record, "cubemap_texel") ||
           (!texels_only && glint_probe_is(record, "screen_cell"));
}

static const struct glint_probe_record *last_step(const struct probe_side *side, const struct glint_probe_record *end,
                                                  bool texels_only) {
    const struct glint_probe_record *last = NULL;
    for (const struct glint_probe_record *r = side->trace.records; r < end; r++)
        if (r->pass == end->pass && r->ray == end->ray && is_step(r, texels_only)) last = r;
    return last;
}

/* "there the ray is 0.02 m behind the surface, 5.4 m deep" */
static void say_depths(struct sentence *s, const struct probe_side *side, const struct glint_probe_record *end) {
    const struct glint_probe_record *step = last_step(side, end, true);
    if (!step) return;
    const double ray = (double)glint_probe_value(step, "ray_m"), surface = (double)glint_probe_value(step, "surface_m");
    if (!isfinite(ray) || !isfinite(surface) || fabs(ray - surface) < 1e-4 * surface) return;
    say(s, ", where it is %s m %s the surface that is stored at %s m", number_text(fabs(ray - surface)),
        ray >= surface ? "behind" : "in front of", number_text(surface));
}

/* The reason as something that a ray does. */
static const char *end_verb(struct glint_probe_label why) {
    if (!why.name) return "ended";
    return !strcmp(why.name, "steps_exhausted") ? "used all its steps"
           : !strcmp(why.name, "no_cubemap")    ? "found no cube map to trace"
                                                : why.text;
}

static void say_end(struct sentence *s, const struct probe_side *side, const struct glint_probe_record *end) {
    const struct glint_probe_label why = glint_probe_label("end reason", glint_probe_value(end, "end"));
    const double steps = (double)glint_probe_value(end, "steps"), m = (double)glint_probe_value(end, "travelled_m");
    const double place = (double)glint_probe_value(end, "cubemap_index");
    const struct glint_probe_record *step = last_step(side, end, false);
    say(s, "%s", end_verb(why));
    if (place >= 0 && place < side->cubemap_count) say(s, " in %s", probe_cubemap(side, place));
    if (isfinite(m)) say(s, " after %s m", number_text(m));
    if (step && !isnan(glint_probe_value(step, "x")))
        say(s, " at pixel %.0f,%.0f", floor((double)glint_probe_value(step, "x")),
            floor((double)glint_probe_value(step, "y")));
    say(s, " (%.0f step%s)", steps, steps == 1 ? "" : "s");
}

static void say_start(struct sentence *s, const struct explain *e) {
    const struct glint_probe_record *ray = explain_record(&e->probe.own, NULL, "screen_ray", false);
    const uint32_t rays = glint_pipeline_rays(e->opened->pipeline);
    if (rays > 1) say(s, "The first of its %u rays", rays);
    else say(s, "Its ray");
    if (!ray) return;
    const double x = floor((double)glint_probe_value(ray, "start_x")),
                 y = floor((double)glint_probe_value(ray, "start_y"));
    if (x != e->probe.pixel[0] || y != e->probe.pixel[1])
        say(s, ", which starts at pixel %.0f,%.0f of the same block,", x, y);
}

static void describe_ray(const struct explain *e, json_t *sentences) {
    struct sentence s = {.used = 0};
    const struct probe_side *own = &e->probe.own;
    const struct glint_probe_record *end;
    const struct glint_pass *pass;
    for (size_t i = 0; (pass = explain_tracer(own, i, &end)); i++) {
        const bool hit = glint_probe_value(end, "end") == (float)GLINT_END_HIT;
        if (i == 0) say_start(&s, e);
        say(&s, i ? "; in the cube maps (%s/%s) it " : " in %s/%s ", pass->slot, pass->variant);
        say_end(&s, own, end);
        if (glint_probe_is(end, "screen_end") && (hit || !(glint_probe_value(end, "finished") > 0)))
            say_depths(&s, own, end);
    }
    if (s.used) say(&s, ".");
    finish(sentences, &s);
}

/* ---- The colour ---- */

/* The passes behind `sampler` that added other texels, and the result of all. */
static void say_filters(struct sentence *s, const struct explain *e, const struct glint_pass *sampler) {
    const struct probe_side *own = &e->probe.own;
    const struct probe_value *reflection = explain_result(own, e->effect);
    size_t filters = 0;
    if (!reflection) return;
    for (size_t p = 0; p < own->pass_count; p++) {
        const struct glint_pass *pass = own->passes[p].pass;
        size_t texels = 0;
        for (size_t i = 0; i < own->trace.count; i++)
            texels += own->trace.records[i].pass == pass && (glint_probe_is(&own->trace.records[i], "neighbour") ||
                                                             glint_probe_is(&own->trace.records[i], "tap"));
        if (!texels || pass == sampler) continue;
        say(s, "%s%s (%zu texel%s)", filters++ ? ", " : "; ", pass->slot, texels, texels == 1 ? "" : "s");
    }
    say(s, filters ? " made of it and of its neighbours the pixel's %s, " : "; the pixel's %s is ", e->effect->noun);
    say_color(s, reflection->values);
}

static void describe_color(const struct explain *e, json_t *sentences) {
    struct sentence s = {.used = 0};
    const struct probe_side *own = &e->probe.own;
    const struct probe_value *radiance = explain_radiance(own, GLINT_ROLE_RAY_RADIANCE);
    const struct glint_probe_record *color = NULL;
    for (size_t p = 0; p < own->pass_count; p++)
        if (own->passes[p].shown && glint_pass_role(own->passes[p].pass, GLINT_ROLE_RAY_RADIANCE))
            color = explain_record(own, own->passes[p].pass, "color", true);
    const struct glint_probe_record *end;
    if (!radiance || !explain_last_tracer(own, &end)) return;
    say(&s, "The colour of the ray, ");
    say_color(&s, radiance->values);
    if (color) {
        const struct glint_probe_label image = glint_probe_label("image", glint_probe_value(color, "image"));
        const double place = (double)glint_probe_value(color, "cubemap_index");
        const double x = (double)glint_probe_value(color, "x"), y = (double)glint_probe_value(color, "y");
        say(&s, ", was read from %s", image.name ? image.name : "an image");
        if (place >= 0 && place < own->cubemap_count) say(&s, " of %s", probe_cubemap(own, place));
        else if (x != 0 || y != 0) say(&s, " at pixel %.0f,%.0f", floor(x), floor(y));
        say(&s, " at level %s", number_text((double)glint_probe_value(color, "level")));
    }
    say_filters(&s, e, radiance->pass);
    say(&s, ".");
    finish(sentences, &s);
}

/* ---- How far it is from what is right ---- */

static double luminance(const double *rgb) {
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

/* "12 % too dark"; where one of both is black or nearly so, their symmetric error. */
static void say_difference(struct sentence *s, const double *found, const double *right) {
    const double ratio = luminance(found) / luminance(right);
    if (!isfinite(ratio) || ratio > 10 || ratio <= 0)
        say(s, "off by a symmetric error of %s", number_text(explain_error(found, right)));
    else if (fabs(ratio - 1) < 0.02)
        say(s, "as bright, with a symmetric error of %s", number_text(explain_error(found, right)));
    else say(s, "%.0f %% too %s", 100 * fabs(ratio - 1), ratio > 1 ? "bright" : "dark");
}

static void describe_reference(const struct explain *e, json_t *sentences) {
    struct sentence s = {.used = 0};
    const struct probe_side *own = &e->probe.own, *reference = &e->probe.reference;
    const struct probe_value *a = explain_radiance(own, GLINT_ROLE_RAY_RADIANCE);
    const struct probe_value *b = explain_radiance(reference, GLINT_ROLE_RAY_RADIANCE);
    const struct glint_probe_record *end;
    const struct glint_pass *tracer = e->probe.has_reference ? explain_last_tracer(reference, &end) : NULL;
    if (!tracer || !a || !b) return;
    const bool there = explain_same_end(own, reference);
    say(&s, "The reference tracers, which skip nothing, end the same ray ");
    if (there) say(&s, "there, too");
    else {
        say(&s, "elsewhere: in %s/%s it ", tracer->slot, tracer->variant);
        say_end(&s, reference, end);
    }
    if (e->goal == EXPLAIN_RAY || !there) {
        say(&s, there ? ", but with the colour " : ", with the colour ");
        say_color(&s, b->values);
        say(&s, "; this ray is ");
        say_difference(&s, a->values, b->values);
    }
    say(&s, ".");
    finish(sentences, &s);
}

static void describe_truth(const struct explain *e, json_t *sentences) {
    struct sentence s = {.used = 0};
    const struct probe_value *reflection = explain_result(&e->probe.own, e->effect);
    const size_t at = (size_t)e->probe.pixel[1] * e->true_pixels.width + e->probe.pixel[0];
    if (!e->truth || !reflection || (e->true_error && !isfinite(e->true_error[at]))) return;
    double right[3];
    explain_triple(&e->true_pixels, at, right);
    const bool run = strcmp(e->truth, "truth") != 0;
    say(&s, "The true %s%s%s%s is ", e->effect->noun, run ? " in " : "", run ? e->truth : "",
        e->without_fog ? " (both without fog)" : "");
    say_color(&s, right);
    if (e->true_error && e->true_error[at] > 0) say(&s, " (standard error %.2g %%)", 100 * (double)e->true_error[at]);
    say(&s, ": the pixel is ");
    say_difference(&s, reflection->values, right);
    say(&s, ".");
    finish(sentences, &s);
}

/* ---- What would change it ---- */

static void describe_best(const struct explain *e, struct sentence *s, const char *what) {
    const struct explain_try *best = &e->best;
    say(s, "With --%s %s (now %s) the symmetric error of %s falls from %s to %s", best->variant ? "use" : "set",
        best->change, best->before, what, number_text(e->start.error), number_text(best->error));
    if (e->goal == EXPLAIN_RESULT)
        say(s, ", and that of the pixels around it from %s to %s", number_text(e->start.around),
            number_text(best->around));
    if (!strncmp(best->change, "pipeline.rays", 13)) say(s, ": it is mostly noise, and nothing else was tried.");
    else if (e->tried == 1) say(s, "; nothing else was tried.");
    else say(s, "; of %zu changes tried%s it helps most.", e->tried, e->more ? " (--tries allows more)" : "");
}

static void describe_change(const struct explain *e, json_t *sentences) {
    struct sentence s = {.used = 0};
    const char *what = e->goal == EXPLAIN_RAY ? "the ray's colour" : "the pixel";
    const struct glint_probe_record *end;
    if (!explain_last_tracer(&e->probe.own, &end)) return;
    if (e->goal == EXPLAIN_NOTHING && !isnan(e->start.error))
        say(&s, "That is within %s: nothing has to change.",
            e->within_noise ? "the noise of what it is compared with" : "a symmetric error of 0.02");
    else if (e->goal == EXPLAIN_NOTHING && !e->truth)
        say(&s, "Nothing says what is right here: the capture holds no true %s, and no --against RUN was given.",
            e->effect->noun);
    else if (e->goal == EXPLAIN_NOTHING) say(&s, "The truth is not known at this pixel.");
    else if (!e->limit) say(&s, "No change was tried (--tries 0).");
    else if (e->best.change[0]) describe_best(e, &s, what);
    else
        say(&s, "None of %zu single changes tried%s takes a third off the error of %s%s.", e->tried,
            e->more ? " (--tries allows more)" : "", what,
            e->goal == EXPLAIN_RESULT ? " without making the pixels around it worse" : "");
    finish(sentences, &s);
}

/* ---- All of it ---- */

json_t *explain_sentences(const struct explain *e) {
    json_t *sentences = json_array();
    describe_surface(e, sentences);
    describe_ray(e, sentences);
    describe_color(e, sentences);
    describe_reference(e, sentences);
    describe_truth(e, sentences);
    describe_change(e, sentences);
    return sentences;
}

static json_t *triple(const struct probe_value *value) {
    return value ? json_numbers(value->values, 3) : json_null();
}

static json_t *try_json(const struct explain_try *t) {
    return json_pack("{s:s, s:s, s:s, s:o, s:o}", "option", t->variant ? "--use" : "--set", "change", t->change,
                     "before", t->before, "error", json_number(t->error), "error_around", json_number(t->around));
}

static json_t *end_json(const struct probe_side *side) {
    const struct glint_probe_record *end;
    const struct glint_pass *pass = explain_last_tracer(side, &end);
    if (!pass) return json_null();
    return json_pack("{s:s, s:s, s:s, s:o, s:o}", "slot", pass->slot, "variant", pass->variant, "end",
                     glint_probe_label("end reason", glint_probe_value(end, "end")).name, "travelled_m",
                     json_number((double)glint_probe_value(end, "travelled_m")), "radiance",
                     triple(explain_radiance(side, GLINT_ROLE_RAY_RADIANCE)));
}

json_t *explain_json(const struct explain *e, json_t *sentences) {
    const char *const goals[] = {"none", "ray", e->effect->name};
    json_t *tries = json_array();
    for (size_t i = 0; i < e->tried; i++) json_array_append_new(tries, try_json(&e->tries[i]));
    return json_pack("{s:s, s:s, s:[i, i], s:O, s:o, s:o, s:o, s:s, s:o, s:o, s:o, s:b}", "run", e->run, "capture",
                     e->probe.capture, "pixel", (int)e->probe.pixel[0], (int)e->probe.pixel[1], "sentences", sentences,
                     "ray", end_json(&e->probe.own), "reference_ray",
                     e->probe.has_reference ? end_json(&e->probe.reference) : json_null(), e->effect->name,
                     triple(explain_result(&e->probe.own, e->effect)), "compared", goals[e->goal], "error",
                     json_number(e->start.error), "best", e->best.change[0] ? try_json(&e->best) : json_null(), "tried",
                     tries, "more", e->more);
}
