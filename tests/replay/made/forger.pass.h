/* Lists whose headers lie. */
PASS("Forger", "made for tests")
READ(texture2D, depth_full)
WRITE(uimageBuffer, list_a, R32UI, "1", LIST, "item", 0xFFFFFFFF, "5 in every word: 125 workgroups for 5 tiles")
WRITE(uimageBuffer, list_b, R32UI, "1", LIST, "item", 0xFFFFFFFF, "the same")
DISPATCH(list_a)
