/* What every variant of this slot reads and writes. */
#line 102
SLOT("A volume of light around the camera, made of cube maps")
READ(textureCubeArray, cubemap_color)
READ(textureCubeArray, cubemap_distance)
READ(textureCube, sky)
READ(texture2D, active_center)
WITHOUT(cubemap_color, "there is no light")
WRITE(image2D, volume_radiance, RGBA16F, "radiance", GRID, "R G B open", 0, "rgb: mean radiance that arrives at the middle of a cell from all directions; a: 1, or 0 where no cube map sees the cell, which is inside of an object or behind one (the leak mask)")
WRITE(image2D, volume_direction, RGBA16F, "1", GRID, "X Y Z cell", 0, "xyz: main direction of that light, the mean of all directions weighted by luminance; w: width of a cell in m")
DISPATCH(volume_radiance)
NEEDS(no_light_volume)
NEEDS(cubemaps)
NEEDS(bounce)
