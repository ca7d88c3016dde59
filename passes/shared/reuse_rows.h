/* How neighbours' reflections are weighted; of every pass that shares them. */
#line 402
CHOICE2(ndf, ggx, blinn_phong, ggx, "Mafia III talk, Neighbor sample reuse", "distribution of normals whose lobes are compared; downsample's must be the same")
PUSH(float, depth_part,     0.01, 0.0, 10.0, "1", "Mafia III talk, Neighbor sample reuse", "a neighbour farther than this part of the depth from the surface's plane counts nothing; 10: no such test")
PUSH(float, roughness_part, 0.1,  0.0, 1.0,  "1", "Mafia III talk, Neighbor sample reuse", "a neighbour whose roughness differs by more counts nothing; 1: no such test")
PUSH(float, fade_from,      0.05, 0.0, 1.0,  "1", "Mafia III talk, Neighbor sample reuse", "surfaces up to this roughness share nothing, because views diverge")
PUSH(float, fade_to,        0.15, 0.0, 1.0,  "1", "Mafia III talk, Neighbor sample reuse", "surfaces from this roughness on share fully")
