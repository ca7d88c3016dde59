/* Reads what this ray made, not the mean. */
PASS("Catch", "made for tests")
PER_RAY
ACCUMULATE(caught)
READ(texture2D, shot)
READ(texture2D, ray)
WRITE(image2D, caught, RGBA16F, "1", HALF, "R G B A", 0, "r: shot less the ray's square, in rays of their own; g: the ray; b, a: two random numbers")
DISPATCH(caught)
