/* Two lists of tiles, made in order by one invocation. */
PASS("Sieve", "made for tests")
READ(texture2D, depth_full)
WRITE(uimageBuffer, list_a, R32UI, "1", LIST, "item", 0xFFFFFFFF, "rough: tiles with (x + 3 y) mod 5 = 0; smooth: 1 or 2; no tile is both")
WRITE(uimageBuffer, list_b, R32UI, "1", LIST, "item", 0xFFFFFFFF, "the same")
SPEC(bool, empty, false, 0, 1, "1", "made", "nothing in list_a is smooth")
DISPATCH(list_a)
