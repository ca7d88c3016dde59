"""The limits for the tests that mutants.py runs, and the reasons why unnoticed mutants are harmless."""

LEAST = 0.85  # fraction of noticed mutants, including harmless ones
# A mutant may loop without end. What takes so many times the processor time of unchanged sources, and this long at least, counts as
# noticed, and so does what takes this many times longer still by the clock.
SLOWER, AT_LEAST_S, HANGS = 10, 30, 20
# Mutants with a known reason are tried by the likeliest programs only, within this time.
ARGUED_S = 60

OUTSIDE = "invocations outside of the picture have no effect: stores outside of an image are discarded, and no workgroup waits for them"
COUNT = "a count of fetches for diagnostics; no other bit depends on it"
ANOTHER_NUMBER = "another one of four random numbers of the same distribution, used for nothing else"
LENGTH = "only the length of the normal is used, which does not depend on the order"

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
        ANOTHER_NUMBER,
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
        LENGTH,
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
    ("display/grade/smooth.glsl", "ivec2 at = pixel + i * along;", "ivec2 at = pixel - i * along;"):
        "both ends of a step are looked for, and exchanging them changes nothing",
    ("display/grade/combined.comp", "if (any(greaterThanEqual(pixel, imageSize(graded)))) return;", "if (false) return;"): OUTSIDE,
    ("display/exposure/stops.comp", "if (any(greaterThanEqual(pixel, imageSize(exposed)))) return;", "if (false) return;"): OUTSIDE,
    ("bloom/bloom/combined.comp", "if (any(greaterThanEqual(pixel, imageSize(bloomed)))) return;", "if (false) return;"): OUTSIDE,
    ("indirect/indirect_apply/bilinear.comp",
     "float weight_of(ivec2 pixel, float depth_m, vec3 normal, ivec2 texel, float texel_m) { return 1.0; }",
     "float weight_of(ivec2 pixel, float depth_m, vec3 normal, ivec2 texel, float texel_m) { return 2.0; }"):
        "the sum is divided by the sum of the weights",
    ("indirect/indirect_temporal/reprojected.comp",
     "if (reflects(center.depth_m, center.normal.xyz)) color = joined(past_of(texel, center, 0.0), color, age);",
     "if (reflects(center.depth_m, center.normal.zyx)) color = joined(past_of(texel, center, 0.0), color, age);"): LENGTH,
    ("indirect/indirect_trace/light.glsl", "fetches += joint ? 5u : 1u;", "fetches +=  1u;"): COUNT,
    ("indirect/indirect_trace/linear.comp", "float shift = dither ? random4(uvec2(start), number, RANDOM_SCREEN_START).x : 0.0;",
     "float shift = dither ? random4(uvec2(start), number, RANDOM_SCREEN_START).y : 0.0;"): ANOTHER_NUMBER,
    ("indirect/volume_make/gather.comp", "if (any(greaterThanEqual(at, size))) return;", "if (false) return;"): OUTSIDE,
    ("occlusion/ao_apply/apply.glsl", "if (any(greaterThanEqual(pixel, imageSize(occlusion)))) return;", "if (false) return;"): OUTSIDE,
    ("occlusion/ao_bounds/boxes.comp", "ivec2 end = min(first + 1 + ivec2(equal(cell, size - 1)), last);",
     "ivec2 end = min(first + 2 + ivec2(equal(cell, size - 1)), last);"):
        "boxes that hold neighbours as well: fewer tiles are skipped, and those that are skipped would have been visible",
    ("occlusion/ao_trace/dda.comp", "precise vec3 direction = normalize(local.x * tangent + local.y * bitangent + local.z * r.normal);",
     "precise vec3 direction = normalize(local.x * tangent - local.y * bitangent + local.z * r.normal);"):
        "the directions of the hemisphere are as frequent on one side of the tangent as on the other",
    ("occlusion/ao_trace/horizon.comp", "float one = reduction(frame.size) / max(max(abs(side.across.x), abs(side.across.y)), 1e-20);",
     "float one = reduction(frame.size) / max(max(abs(side.across.x), abs(side.across.y)), 0.0);"):
        "a slice's direction is perpendicular to the view vector, so that it always moves across the picture",
    ("prepare/cocoon/max.comp", "int cocoon_level() { return int(ceil(log2(max(float(face_size(faces, 0)) / float(size), 1.0)) - 1e-4)); }",
     "int cocoon_level() { return int(ceil(log2(max(float(face_size(faces, 0)) / float(size), 1.0)) - 0.0)); }"):
        "on this device the logarithm of a power of two is exact; on others it may be off, hence the margin",
    ("prepare/cubemap_mips/prefilter.comp", "int size = imageSize(cubemap_color_mips).x, level = int(dispatch_level);",
     "int size = imageSize(cubemap_color_mips).y, level = int(dispatch_level);"): "faces are square",
    ("prepare/downsample/bilinear.comp", "ivec2 source = min(2 * pixel + ivec2(i & 1, i >> 1), last);", "ivec2 source = (2 * pixel + ivec2(i & 1, i >> 1));"):
        "pixels beyond the border repeat those at it with the same proportions; without the clamp they have no depth and do not enter the mean",
    ("reflection/cubemap_select/score.comp", "sum += direction * (0.5 + 0.5 * dot(offset, ray) / max(distance_m, 1e-6));",
     "sum += direction * (1.0 + 0.5 * dot(offset, ray) / max(distance_m, 1e-6));"):
        "every cube map's score grows by the same, so that the best remains the best",
    ("screen_rays/linear_facets.glsl", "fetches += 2u;", "fetches -= 2u;"): COUNT,
    ("shadow/contact_trace/linear.comp", "return march(ray, grid, dither ? random4(uvec2(texel), random_frame(), RANDOM_CONTACT).x : 0.0);",
     "return march(ray, grid, dither ? random4(uvec2(texel), random_frame(), RANDOM_CONTACT).y : 0.0);"): ANOTHER_NUMBER,
    ("antialiasing/taa/scene.comp",
     "vec3 picture(ivec2 pixel) { return texelFetch(scene, min(pixel, textureSize(scene, 0) - 1), 0).rgb; }",
     "vec3 picture(ivec2 pixel) { return texelFetch(scene, (pixel), 0).rgb; }"):
        "without the captured picture the image is one black texel, and a fetch outside of an image is 0 on these devices; GLSL leaves it undefined, hence the guard",
    ("picture/compose/brdf.comp",
     "float rise = fact_fresnel ? texelFetch(fresnel_full, min(pixel, textureSize(fresnel_full, 0) - 1), 0).x : 1.0;",
     "float rise = fact_fresnel ? texelFetch(fresnel_full, (pixel), 0).x : 1.0;"):
        "channels of the G-buffer are as large as the picture; those that the capture lacks are filled with their fallback value",
    ("prepare/surface_levels/picked.comp",
     "ivec2 within = width_of(0) == 1 || picked > 3u ? ivec2(0) : ivec2(picked & 1u, picked >> 1u);",
     "ivec2 within = width_of(1) == 1 || picked > 3u ? ivec2(0) : ivec2(picked & 1u, picked >> 1u);"):
        "where a texel is a pixel, downsample/none has picked 0, which is the same",
    ("reflection/blur/mips.comp",
     "level = clamp(level, 0.0, float(textureQueryLevels(chain) - 1));",
     "level = clamp(level, 0.0, float(textureQueryLevels(chain) + 1));"):
        "radii are at most half of the picture's width w: log2(w / 2), while the coarsest level is floor(log2 w) or more",
    ("filtering/planes.glsl", "if (!(corners.share[i] > 0.0)) continue;", "if (false) continue;"):
        "a share of 0 adds 0 to both sums",
    ("filtering/level_filter.glsl", "if (level + 1 >= textureQueryLevels(levels)) return vec4(0.0);", "if (false) return vec4(0.0);"):
        "a level that the image lacks has the size 0 on these devices, so that no texel of it is found, and the fraction is 0 as well",
    ("previous_frame/history.glsl",
     "if (weight < 1e-3 || any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(frame.size.zw)))) continue;",
     "if (weight < 1e-3  || any(greaterThanEqual(texel, ivec2(frame.size.zw)))) continue;"):
        "a normal that is fetched outside of the image is 0 on these devices, which is no surface",
    ("reflection/transparency/trace.comp", "ivec2 corner = ivec2(floor(place)), last = ivec2(frame.size.zw) - 1;",
     "ivec2 corner = ivec2(floor(place)), last = ivec2(frame.size.zw) ;"):
        "texels beyond the border repeat those at the border with the same proportions; outside of the image they have alpha 0, and do not enter the mean",
    ("reflection/transparent_cubemap_trace/march.comp", "if (!has_distances(best)) return Result(INFINITE, best, END_fallback, 0u, 0u);",
     "if (!has_distances(best)) return Result(INFINITE, best, END_fallback, 0u, 1u);"): COUNT,
    ("reflection/transparent_downsample/nearest.comp", "return texelFetch(transparent_color, pixel, 0).a > 0.0 && reflects(depth_m, surface.xyz);",
     "return texelFetch(transparent_color, pixel, 0).a > 0.0 && reflects(depth_m, surface.zyx);"): LENGTH,
    ("reflection/upscale/source.glsl", "probe(PROBE_neighbour, vec4(texel, weight, color.r), vec4(color.gb, 0.0, 0.0));",
     "probe(PROBE_neighbour, vec4(texel, weight, color.r), vec4(color.gb, 1.0, 0.0));"):
        "a record of this kind has six values; this is the seventh",
    ("shared/active.glsl", "if (gl_LocalInvocationIndex < min(frame.counts.x, ACTIVE_MOST))", "if (gl_LocalInvocationIndex < (frame.counts.x))"):
        "the host activates at most as many cube maps (TABLES_MAX of replay, the highest value of cubemap_active.count)",
    ("survey/reach.comp", "if (gl_LocalInvocationIndex == 0u) imageStore(reached_faces, ivec2(word, 0), uvec4(faces[word]));",
     "if (gl_LocalInvocationIndex == 1u) imageStore(reached_faces, ivec2(word, 0), uvec4(faces[word]));"):
        "after the barrier every invocation of the workgroup reads the same word",
}

# {(file, line, line): missing case}: neither harmless nor noticed yet. A new one fails the test.
MISSING = {}
