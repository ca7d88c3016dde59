/* RULE(id, name, what FORMAT.md says). `validate` reports each under its name; the reader refuses a file on those
   above the line, and the writer never writes what breaks one of them. */
/* clang-format off */
RULE(OPENEXR,   "openexr",          "The file is an OpenEXR file whose headers and chunks are whole and undamaged.")
RULE(VERSION,   "version",          "Every part of a known role carries `glint.version` (int), the same in all; a reader rejects versions that it does not know.")
RULE(NAMES,     "unique-names",     "No two parts have the same name.")
RULE(REQUIRED,  "required-parts",   "A capture holds every required role. A file of cube maps alone, which other captures may name as a sibling, needs none.")
RULE(STORAGE,   "scanline",         "Parts of known roles are flat scanline images in increasing y without subsampling, compressed by NONE, RLE, ZIPS, ZIP, PIZ, PXR24 or B44.")
RULE(WINDOW,    "display-window",   "`displayWindow` and `pixelAspectRatio` are the same in all parts.")
RULE(RESERVED,  "reserved-roles",   "A reserved role is not used before a version defines it.")
RULE(CHANNELS,  "channels",         "A part holds its role's required channels (no Z of a normal that is octahedral, view_xy or spheremap) and no channel that the role does not list.")
RULE(TYPES,     "channel-types",    "`stencil.id`, packed motion and its packed depth are uint; every other listed channel is half or float.")
RULE(SHAPE,     "shape",            "Parts of shape `frame` have the size of `gbuffer`; cube maps are N × 6N, tables N × N² with N at least 2.")
RULE(PROBE,     "probe",            "The levels of a probe are numbered from 1 without a gap, at most 15 beside the finest; each has half the face size of the finer one, at least 1; their roughnesses increase; a box has min < max.")
RULE(ENCODING,  "encoding",         "A declared encoding is one of the values of its table; where nothing is declared, the first one holds.")
RULE(ATTRIBUTE, "attributes",       "Attributes have the type and range of their table, the required ones are there, every number is finite; directions have a length of 1 within 1e-3; a hull has no gap, and a plane nothing below row 0. A part of a role with listed channels has no `envmap`, no other attribute that begins with `glint.` than those that this page has for it, and `glint.storage` names channels of the role.")
RULE(MATRIX,    "matrices",         "World-to-view matrices are a rotation (within 1e-3) and a translation with the last row 0 0 0 1; view-to-clip matrices are invertible and of the stated form, those of shadow maps and volumes are invertible.")
RULE(DEPTH,     "depth-encoding",   "The declared depth encoding agrees with the matrix (near at 0 or at 1; no far plane for `reversed_infinite`), logarithmic depth has 0 < depthNear < depthFar.")
RULE(PREVIOUS,  "previous-camera",  "A capture with `previous.gbuffer` has the previous camera.")
RULE(VOLUME,    "inner-volume",     "An inner volume is complete: a box with min < max, a sphere with a positive radius, a hull with 4 to 64 planes with non-zero normals.")
RULE(LIGHT,     "lights",           "Point and spot lights are numbered from 000 without a gap, at most 64; the inner angle of a cone is not above the outer one, which is above 0.")
RULE(SHADOW,    "shadow",           "The ends of a shadow map's range differ and lie in [0, 1]; the map is of the sun or of a light, which the frame has, and of all surfaces or of a stencil class that it has.")
RULE(GRID,      "volume",           "The height of a volume of light is a whole number of its slices, and its matrix has the last row 0 0 0 1.")
RULE(FROXELS,   "froxels",          "`froxels` has a cell for at least each 256 x 256 pixels of the frame; its height is a whole number of its slices, which are 1 to 1024; 0 ≤ near < far, far from 1e-6 to 1e9 units, and exponential slices have near ≥ far / 1e9.")
RULE(AIR,       "air",              "The mieExtinction of an atmosphere is not below its mieScattering; cloudTop is above cloudBottom. Both lie within ±1e9 m, cloudTile and cloudNoiseTile from 1e-3 to 1e9 m, cloudOffset within ±1e12 m. A part `cloud.density` comes with the attributes of clouds on `gbuffer`; its height is a whole number of 8 slices, and `cloud.height` has its size.")
RULE(SIBLING,   "sibling",          "A sibling is a plain file name in the capture's own folder, its bytes have the stated hash, and it holds a part of the same name with pixels. The part that names it is 1 × 6 pixels, which are black.")
/* ---- pixels: checked by validate alone ---- */
RULE(PIXEL_FINITE,    "pixels-finite",    "No NaN, and no infinity but +inf in view-linear depth and in distances under sky. Where depth says sky (or no surface), the other channels are not checked.")
RULE(PIXEL_NORMAL,    "pixels-normal",    "Decoded normals have a length of 1 within 0.02 before the reader normalises them.")
RULE(PIXEL_RANGE,     "pixels-range",     "Decoded roughness and every channel of unit 1 without an encoding, but `stencil.id`, lie in [0, 1] (within 0.001); radiance, metres (but motion.Z), 1/m and relative errors are not negative; encoded depth, unorm, octahedral, view_xy, spheremap and log2_power values lie in [0, 1]; packed16 values have 16 bits.")
RULE(PIXEL_SKY,       "pixels-sky",       "In cube maps, where A is 0 (sky), R G B are 0 and distance.Z is +inf; where A is 1, distance.Z is a number. Where A is between 0 and 1, as after filtering, both are free.")
RULE(PIXEL_MIRROR,    "pixels-mirror",    "In `truth.mirror`, visible is 0 where distance.Z is +inf (sky) or 0 (no ray).")
/* clang-format on */
#undef RULE
