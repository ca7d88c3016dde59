/* Images that come from the capture, decoded to canonical values. Rows only, read by C.
   CAPTURE(name, format, unit, size, role, channels of the role, required, nothing, meaning) */
CAPTURE(depth_full,       R32F,    "m",  FULL,     "gbuffer", "depth.Z", true, INFINITY, "view-linear depth; +inf where sky")
CAPTURE(normal_full,      RGBA16F, "1",  FULL,     "gbuffer", "normal.X normal.Y normal.Z material.roughness", true, 0, "xyz: unit normal, world axes; w: perceptual roughness")
CAPTURE(albedo_full,      RGBA16F, "1",  FULL,     "gbuffer", "albedo.R albedo.G albedo.B material.metalness", true, 0, "rgb: base colour; a: metalness")
CAPTURE(specular_full,    R16F,    "1",  FULL,     "gbuffer", "material.specular", true, 0, "dielectric reflectance / 0.08; 0 reflects nothing")
CAPTURE(motion_full,      RG32F,   "uv", FULL,     "gbuffer", "motion.X motion.Y", false, 0, "uv one frame earlier minus uv now")
CAPTURE(lit,              RGBA16F, "radiance", FULL, "lit",   "R G B -", true, 0, "diffuse shading with sky, no specular")
CAPTURE(scene,            RGBA16F, "radiance", FULL, "scene", "R G B -", false, 0, "the finished picture")
CAPTURE(previous_lit,     RGBA16F, "radiance", FULL, "previous.lit", "R G B -", false, 0, "lit of the previous frame")
CAPTURE(previous_depth,   R32F,    "m",  FULL,     "previous.gbuffer", "depth.Z", false, INFINITY, "depth_full of the previous frame")
CAPTURE(cubemap_color,    RGBA16F, "radiance", CUBEMAPS, "cubemap", "R G B A", false, 0, "rgb: diffuse-only radiance; a: 0 where sky; layer = place in active_index")
CAPTURE(cubemap_distance, R32F,    "m",  CUBEMAPS, "cubemap", "distance.Z", false, INFINITY, "distance from the centre; +inf where sky")
CAPTURE(sky,              RGBA16F, "radiance", SKY, "sky",    "R G B -", false, 0, "the sky alone")
