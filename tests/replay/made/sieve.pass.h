/* Two lists of pixels, made in order by one invocation. */
PASS("Sieve", "made for tests")
READ(texture2D, depth_full)
WRITE(uimageBuffer, list_a, R32UI, "1", LIST, "item", 0xFFFFFFFF, "pixels x + 65536 y with (x + 3 y) mod 5 = 0")
WRITE(uimageBuffer, list_b, R32UI, "1", LIST, "item", 0xFFFFFFFF, "the same, 1 or 2")
SPEC(bool, empty, false, 0, 1, "1", "made", "list_b has no items")
DISPATCH(list_a)
