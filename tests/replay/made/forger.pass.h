/* A list whose header lies. */
PASS("Forger", "made for tests")
READ(texture2D, depth_full)
WRITE(uimageBuffer, list_a, R32UI, "1", LIST, "item", 0xFFFFFFFF, "the same in every word: with 5, 125 workgroups for 5 items")
WRITE(uimageBuffer, list_b, R32UI, "1", LIST, "item", 0xFFFFFFFF, "the same")
SPEC(uint, word, 5, 0, 5, "1", "made", "what it is")
DISPATCH(list_a)
