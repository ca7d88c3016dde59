/* Comes before all rays. */
PASS("Base", "made for tests")
READ(texture2D, depth_full)
WRITE(image2D, base, R32F, "1", HALF, "Z", 0, "the pixel's number")
DISPATCH(base)
