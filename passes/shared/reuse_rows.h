/* How the reflections of neighbours are weighted. */
#line 402
CHOICE2(ndf, ggx, blinn_phong, ggx, "Mafia III talk, Neighbor sample reuse", "NDF whose lobes are compared; must equal downsample.ndf")
PUSH(float, depth_part,     0.01, 0.0, 10.0, "1", "Mafia III talk, Neighbor sample reuse", "a neighbour farther from the surface's plane than this fraction of the depth gets no weight; 10: no test")
PUSH(float, roughness_part, 0.1,  0.0, 1.0,  "1", "Mafia III talk, Neighbor sample reuse", "a neighbour whose roughness differs by more than this gets no weight; 1: no test")
PUSH(float, fade_from,      0.05, 0.0, 1.0,  "1", "Mafia III talk, Neighbor sample reuse", "surfaces up to this roughness use no neighbours, because their views diverge")
PUSH(float, fade_to,        0.15, 0.0, 1.0,  "1", "Mafia III talk, Neighbor sample reuse", "surfaces from this roughness on use neighbours fully")
