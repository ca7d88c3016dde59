"""The limits for the tests that mutants.py runs, and the reasons why unnoticed mutants are harmless."""

LEAST = 0.85  # fraction of noticed mutants, including harmless ones
# A mutant may loop without end. What takes so many times the processor time of unchanged sources, and this long at least, counts as
# noticed, and so does what takes this many times longer still by the clock.
SLOWER, AT_LEAST_S, HANGS = 10, 30, 20
# Mutants with a known reason are tried by the likeliest programs only, within this time.
ARGUED_S = 60

OUTSIDE = "invocations beyond the picture fetch nothing that is kept: what is stored outside of an image is discarded, and no workgroup waits for them"
COUNT = "a count of fetches that diagnostics show; no other bit depends on it"

# (file, original line, mutated line): reason.
HARMLESS = {
    ("reflection/compose/brdf.comp", "float cosine = clamp(dot(to_viewer, normalize(surface.xyz)), 0.0, 1.0);",
     "float cosine = clamp(dot(to_viewer, normalize(surface.xyz)), 0.0, 2.0);"):
        "two unit vectors' product is beyond 1 by a rounding at most, and what is taken of it is the fifth power of 1 less it",
    ("reflection/compose/contribution.comp", "if (any(greaterThanEqual(pixel, imageSize(composed)))) return;", "if (false) return;"): OUTSIDE,
    ("reflection/cubemap_select/nearest.comp", "if (any(greaterThanEqual(pixel, imageSize(cubemap_best)))) return;", "if (false) return;"): OUTSIDE,
    ("reflection/resolve/hit.comp", "if (any(greaterThanEqual(pixel, imageSize(reflection_half)))) return;", "if (false) return;"): OUTSIDE,
    ("prepare/cubemap_mips/plain.comp", "int size = imageSize(cubemap_color_mips).x, level = int(dispatch_level);",
     "int size = imageSize(cubemap_color_mips).y, level = int(dispatch_level);"): "faces are square",
    ("prepare/cocoon/max.comp", "int width = imageSize(cocoon_distance).x, level = int(dispatch_level);",
     "int width = imageSize(cocoon_distance).y, level = int(dispatch_level);"): "faces are square",
    ("prepare/cubemap_mips/plain.comp", "if (at.x >= size || at.y >= size) return;", "if (at.x >= size || at.x >= size) return;"): OUTSIDE,
    ("reflection/cubemap_select/score.comp", "if (!(visibility > 0.0 && sum + visibility > least)) return sum;", "if (!(visibility > 0.0 )) return sum;"):
        "a cube map that cannot be the best is looked at all the same, and is not the best then either: it spares a fetch",
    ("reflection/cubemap_trace/exact.comp", "fetches += 4u;", "fetches += 5u;"): COUNT,
    ("reflection/cubemap_trace/exact.comp", "vec2 low = face.xy * coarse - 0.5 - cells.part, high = min(low + 2.0, coarse);",
     "vec2 low = face.xy * coarse - 0.5 - cells.part, high = (low + 2.0);"):
        "two lines below, whatever is not below `coarse` becomes the face's border",
    ("reflection/cubemap_trace/march.glsl", "float part = random_scale ? random4(pixel, random_frame(), RANDOM_STEP_SCALE).x : 0.5;",
     "float part = random_scale ? random4(pixel, random_frame(), RANDOM_STEP_SCALE).y : 0.5;"):
        "another of four numbers that are drawn alike and used for nothing else",
    ("reflection/cubemap_trace/march.glsl", "if (skip_volume && fact_volumes) now.t = skipped(now.t, step_m, result.place, origin, direction);",
     "if (skip_volume ) now.t = skipped(now.t, step_m, result.place, origin, direction);"):
        "a table of volumes that holds none is asked, and says so: the fact spares the asking",
    ("reflection/cubemap_trace/sphere.comp",
     "if (!fact_volumes) return end_on_proxy(origin, direction, start_m, best, within_sphere(origin - center, direction, default_m), 0u);",
     "if (false) return end_on_proxy(origin, direction, start_m, best, within_sphere(origin - center, direction, default_m), 0u);"):
        "a table of volumes that holds none is asked, and leads to the same sphere: the fact spares a fetch",
    ("reflection/cubemap_trace/proxy.glsl", "return root < 0.0 ? -ALWAYS : along + vec2(-sqrt(root), sqrt(root));",
     "return root < 0.0 ? ALWAYS : along + vec2(-sqrt(root), sqrt(root));"):
        "a sphere that a ray never leaves is looked up by direction as one that it never meets",
    ("reflection/screen_trace/linear.glsl", "return mix(s_front, s, clamp(gap_front / (gap_front - gap), 0.0, 1.0));",
     "return mix(s_front, s, clamp(gap_front / (gap_front - gap), 0.0, 2.0));"):
        "gap is negative here, so that the quotient of a gap in front is below 1, and that of one behind is no more than 1",
    ("reflection/temporal/history.glsl", "return total > 1e-3 ? Past(past.color / total, past.age / total) : Past(vec4(0.0), 0.0);",
     "return total > 1e-3 ? Past(past.color / total, past.age / total) : Past(vec4(1.0), 0.0);"):
        "a past of age 0 has the weight 0, whatever its colour",
    ("reflection/transparency/trace.comp", "ivec2 texel = clamp(corner + ivec2(i & 1, i >> 1), ivec2(0), last);",
     "ivec2 texel = (corner + ivec2(i & 1, i >> 1));"):
        "texels beyond the border repeat those at it in the proportions that these have among themselves; not held there they are outside of the "
        "image, hold no alpha, and are left out of the mean",
    ("shared/cube_chain.glsl", "if (level == 0 || reach == 0) return texelFetch(faces, at, level);", "if (false) return texelFetch(faces, at, level);"):
        "nobody asks for level 0, and without neighbours the one tap that is left is the texel itself",
    ("reflection/screen_trace/hiz.comp", "if (!pass_behind || highest * fma(thickness_m, farthest, 1.0 + thickness) >= 0.999999 * farthest) return false;",
     "if (!pass_behind || highest * fma(thickness_m, farthest, 2.0 + thickness) >= 0.999999 * farthest) return false;"):
        "cells are looked into that could be passed at once: more steps to the same end",
    ("prepare/downsample/pick.comp", "float depth_m = texelFetch(depth_full, min(block + ivec2(i & 1, i >> 1), last), 0).x;",
     "float depth_m = texelFetch(depth_full, (block + ivec2(i & 1, i >> 1)), 0).x;"):
        "choose() looks at no pixel outside of the picture, whatever was fetched there",
    ("reflection/resolve/blurred.comp", "vec2 place = uv + at * radius / vec2(frame.size.xy);",
     "vec2 place = uv - at * radius / vec2(frame.size.xy);"): "the taps lie evenly on both sides of the middle",
    ("reflection/screen_trace/linear.glsl", "if (verify) result.fetches++;", "if (false) result.fetches++;"): COUNT,
    ("reflection/screen_trace/hiz.comp", "int coarsest_level() { return max(findMSB(min(frame.size.z, frame.size.w)) - 2, 0); }",
     "int coarsest_level() { return (findMSB(min(frame.size.z, frame.size.w)) - 2); }"):
        "a ray goes up only from a level that is below the coarsest: from level 0 neither below 0 nor below less",
    ("reflection/upscale/best_match.comp", "texel = clamp(texel, ivec2(0), last);", "texel = (texel);"):
        "a texel outside of the picture is one without a ray, whatever was fetched there",
    ("reflection/upscale/edges.comp", "if (any(greaterThanEqual(pixel, imageSize(reflection)))) return;", "if (false) return;"): OUTSIDE,
    ("reflection/temporal_sharp/clamped.comp",
     "bool steadied = tile_works && roughness <= sharp_roughness && reflects(depth_m, surface.xyz) && is_shown(pixel);",
     "bool steadied = tile_works && roughness <= sharp_roughness && reflects(depth_m, surface.zyx) && is_shown(pixel);"):
        "of a normal only the length is asked, which it has in any order",
    ("reflection/temporal_sharp/clamped.comp", "if (count == 0.0) return past;", "if (false) return past;"):
        "the bounds are NaN then, 0/0, and min and max keep what is a number (on this device; GLSL leaves it open, hence the guard)",
    ("shared/facet.glsl", "float fall(float depth_m, float other_m) { return depth_m == other_m ? 0.0 : 1.0 - depth_m / other_m; }",
     "float fall(float depth_m, float other_m) { return  1.0 - depth_m / other_m; }"):
        "on this device a quotient of equals is 1; on others it may be 2.5 ULP beside it, and there the cases of facets notice",
    ("reflection/cubemap_trace/exact.comp", "walk.t = beyond * (1.0 + 1e-6) + 1e-6;", "walk.t = beyond * (1.0 + 1e-6) + 0.0;"):
        "a ray that rounding leaves at the border of a cell finds nothing beyond it on any level, and then goes on by a part of a texel as ever",
    ("shared/list_maker.glsl", "rows = max((groups + 32767u) / 32768u, 1u);", "rows = max((groups + 32768u) / 32768u, 1u);"):
        "at a multiple of 32,768 workgroups a row more of them, whose places lie beyond the list's count",
    ("prepare/downsample/pick.comp", "ivec2 block = 2 * pixel, last = ivec2(frame.size.xy) - 1;", "ivec2 block = 2 * pixel, last = ivec2(frame.size.xy) + 1;"):
        "choose() looks at no pixel outside of the picture, whatever was fetched there",
    ("reflection/transparency/trace.comp",
     "float cosine = fresnel ? clamp(abs(dot(normalize(mat3(frame.world_from_view) * view), normalize(normal))), 0.0, 1.0) : 1.0;",
     "float cosine = fresnel ? (abs(dot(normalize(mat3(frame.world_from_view) * view), normalize(normal)))) : 1.0;"):
        "two unit vectors' product is beyond 1 by a rounding at most, and what is taken of it is continuous there",
    ("reflection/transparent_resolve/main.glsl", "vec4 color = tile_works && reflects(depth_m, normal) ? resolved(texel, depth_m, normal) : vec4(0.0);",
     "vec4 color = tile_works  ? resolved(texel, depth_m, normal) : vec4(0.0);"):
        "what has no surface has a way of 0 that ended nowhere, which is no source either: the guard spares the asking",
}

# {(file, line, line): missing case}: neither harmless nor noticed yet. A new one fails the test.
MISSING = {}
