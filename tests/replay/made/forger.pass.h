/* A list whose header lies. */
PASS("Forger", "made for tests")
READ(texture2D, depth_full)
WRITE(uimageBuffer, list_a, R32UI, "1", LIST, "item", 0xFFFFFFFF, "5 in every texel: 125 workgroups for 5 items")
WRITE(uimageBuffer, list_b, R32UI, "1", LIST, "item", 0xFFFFFFFF, "the same")
DISPATCH(list_a)
