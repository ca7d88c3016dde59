/* What a capture need not have, and what a replay loses without it. Rows only, read by C.
   ABSENCE(role, channels, cost): a part of the role, or of one that has it, the channels that begin so. A replay warns once of each that its
   passes would read, glint strip says what is left out, and glint info which role would open what.
   ABSENCE_UNLESS(other, …), ABSENCE_BESIDE(other, …): the same in captures without, or with, a part of another role. */
ABSENCE_UNLESS("probe", "cubemap", "", "rays that leave the screen end in the sky where the picture shows it, and find nothing elsewhere")
ABSENCE_BESIDE("probe", "cubemap", "", "rays that leave the screen are looked up in the probe, also where something hides what it shows")
ABSENCE("cubemap", "distance", "in cube maps without distances rays are looked up by direction, as if everything were far away; if none has any, there is no cocoon")
ABSENCE_UNLESS("probe", "sky", "", "rays to the sky take what the cube maps hold there, which may be black")
ABSENCE("scene", "", "screen hits show the diffuse picture, without the reflections and translucency of what they hit")
ABSENCE("previous.scene", "", "hits in the previous frame show its diffuse picture")
ABSENCE("previous.lit", "", "screen hits show this frame's picture instead of the previous one's, unless there is the previous scene")
ABSENCE("previous.gbuffer", "", "colours of the previous frame are used also where something else was in front then")
ABSENCE("indirect", "", "occlusion has nothing to darken: which part of the light is ambient is not known, and light of the sun and of lamps is not to be darkened")
ABSENCE("volume.000", "", "indirect light that the screen does not show comes from a volume made of the cube maps, or is black without those")
ABSENCE("emissive", "", "what surfaces emit themselves is not known apart from the light that falls on them")
ABSENCE("ao", "", "the engine's own occlusion is not there to be compared with, or taken out of the ambient light")
ABSENCE("sun", "", "contact shadows are all that shades the sun: what casts a shadow from farther away is not known")
ABSENCE("gbuffer", "motion.X", "moving objects are reprojected as if they stood still, and smear")
ABSENCE("gbuffer", "motion.Z", "objects that move along the view are compared with the previous frame at the wrong depth")
ABSENCE("gbuffer", "material.metalness", "every surface is a dielectric, and metals reflect a few per cent")
ABSENCE("gbuffer", "material.specular", "every dielectric reflects 4 % at normal incidence, and surfaces without a reflection get one")
ABSENCE("gbuffer", "albedo", "metals reflect 80 % without colour")
ABSENCE("gbuffer", "vertexNormal", "edges between surfaces are found by shading normals, which bumps mislead")
ABSENCE("gbuffer", "stencil", "what the camera holds is reflected, although what it hides was never rendered")
