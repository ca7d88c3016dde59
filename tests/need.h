/* What a test program runs is looked for when it runs: Meson may have configured before it was installed. */
#ifndef GLINT_TEST_NEED_H
#define GLINT_TEST_NEED_H

/* Fails the calling test when no such program is on the PATH, and names the Debian package that has it. */
void need_program(const char *name);

#endif
