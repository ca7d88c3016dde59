/* How the surface of water bends and reflects light. */
#line 302
SPEC(bool,  refraction, true, 0, 1, "1", "GTA V article, Water", "the bottom is sampled where the refracted ray hits it; off: straight through")
SPEC(int,   refinements, 2,   0, 8, "1", "glint", "number of times the bottom's depth is sampled again at the new end of the refracted ray")
SPEC(bool,  fresnel,    true, 0, 1, "1", "glint; the article says nothing", "Fresnel reflectance by angle; off: that of normal incidence")
SPEC(bool,  environment, true, 0, 1, "1", "GTA V article, Environment Cubemap", "where the planar map shows nothing, sample the cube map nearest to the player; off: the sky only")
PUSH(float, index,      1.333, 1.0, 4.0, "1", "glint", "refractive index")
PUSH(float, intensity,  1.0,  0.0, 16.0, "1", "glint", "factor on the reflection; 0: only what is behind the water")
