/* What every variant of this slot reads and writes. */
#line 102
SLOT("Sunlight that the atmosphere scatters")
WRITE(image2D, sky_rayleigh, RGBA16F, "radiance · sr", QUARTER, "R G B -", 0, "sunlight that molecules scatter along the view ray, up to the end of the atmosphere or to the ground; times the phase function: radiance")
WRITE(image2D, sky_mie, RGBA16F, "radiance · sr", QUARTER, "R G B -", 0, "the same of particles")
WRITE(image2D, sky_passed, RGBA16F, "1", QUARTER, "R G B open", 1, "rgb: the part of light from behind that passes the air; open: 1 where the ray leaves the atmosphere, 0 where it meets the ground")
DISPATCH(sky_rayleigh)
NEEDS(atmosphere)
NEEDS(sky)
REFERENCE_NONE("it is part of a picture, and the reference is compared with truths of surfaces")
