/* What the passes of a multilayer EXR of Blender become: channels of Blender 3.4, `VIEWLAYER.PASS.COMPONENT`.
   CHANNEL(part, channel, passes, scale, need, without)
     passes: names without the view layer, of which the first that is there is taken; AOVs are found whatever the case of their letters
     need: NEEDED or OPTIONAL, of the file or the manifest; without: what a capture lacks then
   lit is (DiffDir + DiffInd) · DiffCol + Emit + Env, row by row. */
/* clang-format off */
CHANNEL("gbuffer", "depth.Z",            "Depth.Z",                                    1,  NEEDED,   "switch on the pass Z")
CHANNEL("gbuffer", "normal.X",           "Normal.X",                                   1,  NEEDED,   "switch on the pass Normal")
CHANNEL("gbuffer", "normal.Y",           "Normal.Y",                                   1,  NEEDED,   "switch on the pass Normal")
CHANNEL("gbuffer", "normal.Z",           "Normal.Z",                                   1,  NEEDED,   "switch on the pass Normal")
CHANNEL("gbuffer", "material.roughness", "roughness.X roughness.R",                    1,  NEEDED,   "add an AOV of this name to view layer and materials, or state parts.gbuffer.material.roughness in the manifest")
CHANNEL("gbuffer", "material.metalness", "metalness.X metallic.X metalness.R metallic.R", 1, OPTIONAL, "no AOV metalness or metallic; nothing is a metal")
CHANNEL("gbuffer", "material.specular",  "specular.X specular.R",                      1,  OPTIONAL, "no AOV specular; 0.5 everywhere")
CHANNEL("gbuffer", "albedo.R",           "albedo.R DiffCol.R",                         1,  OPTIONAL, "no AOV albedo, no pass Diffuse Color")
CHANNEL("gbuffer", "albedo.G",           "albedo.G DiffCol.G",                         1,  OPTIONAL, "")
CHANNEL("gbuffer", "albedo.B",           "albedo.B DiffCol.B",                         1,  OPTIONAL, "")
CHANNEL("gbuffer", "motion.X",           "Vector.X",                                   1,  OPTIONAL, "no pass Vector; the cameras alone reproject the previous frame")
CHANNEL("gbuffer", "motion.Y",           "Vector.Y",                                   -1, OPTIONAL, "")
CHANNEL("lit",     "R",                  "DiffDir.R",                                  1,  NEEDED,   "switch on the passes Diffuse Direct, Indirect and Color, Emission, Environment")
CHANNEL("lit",     "G",                  "DiffDir.G",                                  1,  NEEDED,   "switch on the passes Diffuse Direct, Indirect and Color, Emission, Environment")
CHANNEL("lit",     "B",                  "DiffDir.B",                                  1,  NEEDED,   "switch on the passes Diffuse Direct, Indirect and Color, Emission, Environment")
CHANNEL("scene",   "R",                  "Combined.R",                                 1,  OPTIONAL, "no pass Combined; presets that sample the finished picture take lit")
CHANNEL("scene",   "G",                  "Combined.G",                                 1,  OPTIONAL, "")
CHANNEL("scene",   "B",                  "Combined.B",                                 1,  OPTIONAL, "")
/* clang-format on */
