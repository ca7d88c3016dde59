/* Faces of the active cube maps that the ways of mirror rays cross, as the centres see them. */
PASS("Faces that rays come to", "glint")
WORKGROUP(8, 16)
#line 102
SLOT("What a frame holds, for the plan")
READ(texture2D, depth_full)
READ(texture2D, normal_full)
READ(texture2D, albedo_full)
READ(texture2D, specular_full)
READ(texture2D, active_center)
WRITE(uimageBuffer, ray_ways, R32UI, "1", LIST, "faces", 0xFFFFFFFFu, "of each 64 x 64 pixels, eight words: three of the faces that are crossed, bit 6 * place + face; three of those and the faces nearby")
DISPATCH(ray_ways)
REFERENCE_NONE("it makes no image of the picture")
