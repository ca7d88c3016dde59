/* cmocka, with the headers that its own needs before it. */
#ifndef GLINT_TEST_UNIT_H
#define GLINT_TEST_UNIT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

/* A parameter that a signature requires and that is not used. */
#define UNUSED __attribute__((unused))

#endif
