/* What every variant of this slot reads and writes. */
#line 102
SLOT("Ambient occlusion, a noisy first estimate")
READ(texture2D, depth_half)
READ(texture2D, normal_half)
READ(utexture2D, pick)
READ(texture2D, vertex_normal_full)
WITHOUT(vertex_normal_full, "normals=vertex uses shading normals")
WRITE(image2D, occlusion_half, R16F, "1", HALF, "visibility", 1, "cosine-weighted fraction of the directions around the normal in which no surface is nearer than the radius; 1: fully visible. A noisy estimate may lie outside of 0 to 1")
DIAGNOSTIC(image2D, occluder_distance, R16F, "m", HALF, "Z", INFINITY, "distance to the nearest surface that was found to occlude; +inf: none")
DIAGNOSTIC(uimage2D, occlusion_steps, R32UI, "steps", HALF, "steps", 0, "points of the depth buffer that were compared")
DIAGNOSTIC(uimage2D, occlusion_fetches, R32UI, "fetches", HALF, "fetches", 0, "texture fetches made")
CHOICE2(radius_in, world, world, screen, "Mafia DE article, SSAO", "world: surfaces occlude up to radius_m; screen: up to the same radius in the picture, whatever their distance, as in the article")
CHOICE2(normals, shading, shading, vertex, "Mafia DE article, GBuffer Pass", "normal about which directions are distributed; vertex: the geometric one where the capture has it")
PUSH(float, radius_m, 1.0, 0.0, 1e6, "m", "glint", "distance up to which surfaces occlude, with radius_in=world; 0: nothing occludes")
PUSH(float, radius_part, 0.1, 0.0, 4.0, "1", "Mafia DE article, SSAO (without a value)", "the same as a fraction of the picture's height, with radius_in=screen")
NEEDS(surfaces)
PER_RAY
ACCUMULATE(occlusion_half)
