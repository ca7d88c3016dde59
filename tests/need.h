/* Programs that tests run are searched when the test runs, because they may be installed after Meson configures. */
#ifndef GLINT_TEST_NEED_H
#define GLINT_TEST_NEED_H

/* Fails the calling test if the program is not on the PATH, and names the Debian package that contains it. */
void need_program(const char *name);

#endif
