/* Works on the tiles of a list, or on the whole image. */
PASS("Worker", "made for tests")
READ(texture2D, depth_full)
WRITE(image2D, worked, R32F, "1", HALF, "Z", 7, "7 where the range leaves the texel out or (x + 3 y) mod 5 is neither 1 nor 2; else 10 and the texel's number in thousands")
SPEC(bool, tell, false, 0, 1, "1", "made", "every texel of the range counts, and the number of the range is added, from 1, and 5 more by list_b")
DISPATCH(worked)
DISPATCH_LIST(list_none, shown)
DISPATCH_LIST(list_a, smooth)
DISPATCH_LIST(list_b, shown)
