/* Cube maps with levels, written by layer and read by direction. */
PASS("Cubes", "made for tests")
READ(textureCubeArray, cubemap_color)
READ_OWN(textureCubeArray, levels, cubes)
WRITE(image2DArray, cubes, R32F, "1", CUBEMAPS_MIPS, "Z", 0, "level 0: the layer; coarser: the finer one's value and 1000")
DISPATCH_LEVELS(cubes, 0, -1, down)
