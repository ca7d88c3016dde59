/* Reads what the other made passes make, when they are there. */
PASS("Reader", "made for tests")
READ(texture2D, chain)
OPTIONAL_READ(textureCubeArray, cubes, R32F, CUBEMAPS_MIPS, 5)
WRITE(image2D, seen, RGBA32F, "1", FULL, "R G B A", 0, "chain's levels 0, 2 and 4 here; cubes' level 1 of layer 6")
DISPATCH(seen)
