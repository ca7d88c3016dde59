/* Comes after all rays. */
PASS("Tally", "made for tests")
READ(texture2D, shot)
READ(texture2D, caught)
READ(texture2D, ray)
WRITE(image2D, tallied, RGBA32F, "1", HALF, "R G B A", 0, "r: shot; g: caught's r; b: ray; a: number of the ray here")
DISPATCH(tallied)
