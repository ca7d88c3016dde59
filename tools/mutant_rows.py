"""The limits for the tests that mutants.py runs, and the reasons why unnoticed mutants are harmless."""

LEAST = 0.85  # fraction of noticed mutants, including harmless ones
# A mutant may loop without end. What takes so many times the processor time of unchanged sources, and this long at least, counts as
# noticed, and so does what takes this many times longer still by the clock.
SLOWER, AT_LEAST_S, HANGS = 10, 30, 20
# Mutants with a known reason are tried by the likeliest programs only, within this time.
ARGUED_S = 60

OUTSIDE = "invocations outside of the picture have no effect: stores outside of an image are discarded, and no workgroup waits for them"
COUNT = "a count of fetches for diagnostics; no other bit depends on it"

# (file, original line, mutated line): reason.
HARMLESS = {
    ("picture/compose/brdf.comp", "float cosine = clamp(dot(to_viewer, normalize(surface.xyz)), 0.0, 1.0);",
     "float cosine = clamp(dot(to_viewer, normalize(surface.xyz)), 0.0, 2.0);"):
        "the dot product of two unit vectors exceeds 1 by rounding at most, and only the fifth power of 1 minus it is used",
    ("picture/compose/contribution.comp", "if (any(greaterThanEqual(pixel, imageSize(composed)))) return;", "if (false) return;"): OUTSIDE,
    ("reflection/cubemap_select/nearest.comp", "if (any(greaterThanEqual(pixel, imageSize(cubemap_best)))) return;", "if (false) return;"): OUTSIDE,
    ("reflection/resolve/hit.comp", "if (any(greaterThanEqual(pixel, imageSize(reflection_half)))) return;", "if (false) return;"): OUTSIDE,
    ("prepare/cubemap_mips/plain.comp", "int size = imageSize(cubemap_color_mips).x, level = int(dispatch_level);",
     "int size = imageSize(cubemap_color_mips).y, level = int(dispatch_level);"): "faces are square",
    ("prepare/cocoon/max.comp", "int width = imageSize(cocoon_distance).x, level = int(dispatch_level);",
     "int width = imageSize(cocoon_distance).y, level = int(dispatch_level);"): "faces are square",
    ("prepare/cubemap_mips/plain.comp", "if (at.x >= size || at.y >= size) return;", "if (at.x >= size || at.x >= size) return;"): OUTSIDE,
    ("reflection/cubemap_select/score.comp", "if (!(visibility > 0.0 && sum + visibility > least)) return sum;", "if (!(visibility > 0.0 )) return sum;"):
        "a cube map that cannot be the best is tested all the same, and is not chosen: the guard saves a fetch",
    ("reflection/cubemap_trace/exact.comp", "fetches += 4u;", "fetches += 5u;"): COUNT,
    ("reflection/cubemap_trace/exact.comp", "vec2 low = face.xy * coarse - 0.5 - cells.part, high = min(low + 2.0, coarse);",
     "vec2 low = face.xy * coarse - 0.5 - cells.part, high = (low + 2.0);"):
        "two lines below, every value that is not below `coarse` becomes the border of the face",
    ("reflection/cubemap_trace/march.glsl", "float part = random_scale ? random4(pixel, random_frame(), RANDOM_STEP_SCALE).x : 0.5;",
     "float part = random_scale ? random4(pixel, random_frame(), RANDOM_STEP_SCALE).y : 0.5;"):
        "another one of four random numbers of the same distribution, used for nothing else",
    ("reflection/cubemap_trace/march.glsl", "if (skip_volume && fact_volumes) now.t = skipped(now.t, step_m, result.place, origin, direction);",
     "if (skip_volume ) now.t = skipped(now.t, step_m, result.place, origin, direction);"):
        "an empty table of volumes is read and gives the same result: the fact saves the reads",
    ("reflection/cubemap_trace/sphere.comp",
     "if (!fact_volumes) return end_on_proxy(origin, direction, start_m, best, within_sphere(origin - center, direction, default_m), 0u);",
     "if (false) return end_on_proxy(origin, direction, start_m, best, within_sphere(origin - center, direction, default_m), 0u);"):
        "an empty table of volumes is read and gives the same sphere: the fact saves a fetch",
    ("reflection/cubemap_trace/proxy.glsl", "return root < 0.0 ? -ALWAYS : along + vec2(-sqrt(root), sqrt(root));",
     "return root < 0.0 ? ALWAYS : along + vec2(-sqrt(root), sqrt(root));"):
        "a ray that never leaves the sphere is sampled by direction, as is one that never meets it",
    ("screen_rays/linear.glsl", "return mix(s_front, s, clamp(gap_front / (gap_front - gap), 0.0, 1.0));",
     "return mix(s_front, s, clamp(gap_front / (gap_front - gap), 0.0, 2.0));"):
        "gap is negative here, so that the quotient is at most 1",
    ("previous_frame/history.glsl", "return total > 1e-3 ? Past(past.color / total, past.age / total) : Past(vec4(0.0), 0.0);",
     "return total > 1e-3 ? Past(past.color / total, past.age / total) : Past(vec4(1.0), 0.0);"):
        "a history of age 0 has the weight 0, whatever its colour",
    ("reflection/transparency/trace.comp", "ivec2 texel = clamp(corner + ivec2(i & 1, i >> 1), ivec2(0), last);",
     "ivec2 texel = (corner + ivec2(i & 1, i >> 1));"):
        "texels beyond the border repeat those at the border with the same proportions; without the clamp they are outside of the "
        "image, have alpha 0, and do not enter the mean",
    ("shared/cube_chain.glsl", "if (level == 0 || reach == 0) return texelFetch(faces, at, level);", "if (false) return texelFetch(faces, at, level);"):
        "level 0 is never requested, and without neighbours the only tap is the texel itself",
    ("screen_rays/hiz.glsl", "if (!pass_behind || highest * fma(thickness_m, farthest, 1.0 + thickness) >= 0.999999 * farthest) return false;",
     "if (!pass_behind || highest * fma(thickness_m, farthest, 2.0 + thickness) >= 0.999999 * farthest) return false;"):
        "more cells are tested than necessary: more steps with the same result",
    ("prepare/downsample/pick.comp", "float depth_m = texelFetch(depth_full, min(block + ivec2(i & 1, i >> 1), last), 0).x;",
     "float depth_m = texelFetch(depth_full, (block + ivec2(i & 1, i >> 1)), 0).x;"):
        "choose() ignores pixels outside of the picture, whatever was fetched there",
    ("reflection/resolve/blurred.comp", "precise vec2 place = uv + vec2(2 * ivec2(i % taps, i / taps) + 1 - taps) * apart;",
     "precise vec2 place = uv - vec2(2 * ivec2(i % taps, i / taps) + 1 - taps) * apart;"): "the taps are symmetric about the middle",
    ("screen_rays/linear.glsl", "if (verify) result.fetches++;", "if (false) result.fetches++;"): COUNT,
    ("screen_rays/hiz.glsl", "int coarsest_level() { return max(findMSB(min(frame.size.z, frame.size.w)) - 2, 0); }",
     "int coarsest_level() { return (findMSB(min(frame.size.z, frame.size.w)) - 2); }"):
        "a ray ascends only from a level below the coarsest: level 0 is below neither 0 nor less",
    ("reflection/upscale/best_match.comp", "texel = clamp(texel, ivec2(0), last);", "texel = (texel);"):
        "a texel outside of the picture counts as one without a ray, whatever was fetched there",
    ("reflection/upscale/edges.comp", "if (any(greaterThanEqual(pixel, imageSize(reflection)))) return;", "if (false) return;"): OUTSIDE,
    ("reflection/temporal_sharp/clamped.comp",
     "bool steadied = tile_works && roughness <= sharp_roughness && reflects(depth_m, surface.xyz) && is_shown(pixel);",
     "bool steadied = tile_works && roughness <= sharp_roughness && reflects(depth_m, surface.zyx) && is_shown(pixel);"):
        "only the length of the normal is used, which does not depend on the order",
    ("reflection/temporal_sharp/clamped.comp", "if (count == 0.0) return past;", "if (false) return past;"):
        "the bounds are then NaN, 0/0, and min and max return the operand that is a number (on this device; GLSL leaves it undefined, hence the guard)",
    ("shared/facet.glsl", "float fall(float depth_m, float other_m) { return depth_m == other_m ? 0.0 : 1.0 - depth_m / other_m; }",
     "float fall(float depth_m, float other_m) { return  1.0 - depth_m / other_m; }"):
        "on this device the quotient of equal numbers is 1; on others it may be off by 2.5 ULP, which the facet cases would notice",
    ("reflection/cubemap_trace/exact.comp", "walk.t = beyond * (1.0 + 1e-6) + 1e-6;", "walk.t = beyond * (1.0 + 1e-6) + 0.0;"):
        "a ray that rounding leaves at the border of a cell finds nothing behind it on any level, and then advances by a fraction of a texel as before",
    ("shared/list_maker.glsl", "rows = max((groups + 32767u) / 32768u, 1u);", "rows = max((groups + 32768u) / 32768u, 1u);"):
        "at a multiple of 32,768 workgroups one more row of them, whose indices are beyond the end of the list",
    ("prepare/downsample/pick.comp", "ivec2 block = 2 * pixel, last = ivec2(frame.size.xy) - 1;", "ivec2 block = 2 * pixel, last = ivec2(frame.size.xy) + 1;"):
        "choose() ignores pixels outside of the picture, whatever was fetched there",
    ("reflection/transparency/trace.comp",
     "float cosine = fresnel ? clamp(abs(dot(normalize(mat3(frame.world_from_view) * view), normalize(normal))), 0.0, 1.0) : 1.0;",
     "float cosine = fresnel ? (abs(dot(normalize(mat3(frame.world_from_view) * view), normalize(normal)))) : 1.0;"):
        "the dot product of two unit vectors exceeds 1 by rounding at most, and the functions of it are continuous there",
    ("reflection/transparent_resolve/main.glsl", "vec4 color = tile_works && reflects(depth_m, normal) ? resolved(texel, depth_m, normal) : vec4(0.0);",
     "vec4 color = tile_works  ? resolved(texel, depth_m, normal) : vec4(0.0);"):
        "texels without a surface have a travelled distance of 0 and no source, so that they are black, too: the guard saves work",
}

# {(file, line, line): missing case}: neither harmless nor noticed yet. A new one fails the test.
MISSING = {}
