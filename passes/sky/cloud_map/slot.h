/* What every variant of this slot reads and writes. */
#line 102
SLOT("Clouds before the sky")
READ(texture2D, cloud_density)
READ(texture2D, cloud_height)
READ(texture2D, cloud_noise)
READ(texture2D, depth_full)
WRITE(image2D, cloud_map, RGBA16F, "1", FULL, "mask single multiple distance", 0, "mask: the part of the light from behind that clouds keep away; single, multiple: radiance that they scatter to the camera for a sun of irradiance 1, once and more than once, 1/sr; distance: of what is seen of them, mean in km; all 0 where no sky is seen")
DISPATCH(cloud_map)
NEEDS(clouds)
NEEDS(sky)
WITHOUT(cloud_height, "clouds reach up to the upper side of their layer")
WITHOUT(cloud_noise, "clouds are as smooth as their other textures")
REFERENCE_NONE("it is part of a picture, and the reference is compared with truths of surfaces")
