/* Makes something else for each ray. */
PASS("Cast", "made for tests")
PER_RAY
ACCUMULATE(shot)
READ(texture2D, base)
WRITE(image2D, shot, R32F, "1", HALF, "Z", 0, "base and the ray's square")
WRITE(image2D, ray, R32F, "1", HALF, "Z", 0, "the ray's number; nobody accumulates it")
DISPATCH(shot)
