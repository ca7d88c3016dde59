/* Works on the items of two lists, or on the whole image. */
PASS("Worker", "made for tests")
READ(texture2D, depth_full)
OPTIONAL_READ(utextureBuffer, list_a, R32UI, LIST, 0xFFFFFFFF)
OPTIONAL_READ(utextureBuffer, list_b, R32UI, LIST, 0xFFFFFFFF)
WRITE(image2D, worked, R32F, "1", HALF, "Z", 7, "10 + phase where an item lies, and the pixel's number in thousands")
DISPATCH(worked)
DISPATCH_LIST(list_a)
DISPATCH_LIST(list_b)
