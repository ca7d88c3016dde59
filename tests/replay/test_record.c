/* Records of JSON: what text they can hold, as Jansson has it, and what lacks something is none. */
#include <string.h>

#include "record.h"
#include "unit.h"

static uint32_t next(uint32_t *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

/* Bytes of texts in UTF-8 and others that look like it: lengths, overlong forms, surrogates, the last code point. */
static void holds_the_texts_that_jansson_holds(UNUSED void **state) {
    static const unsigned char bytes[] = {'a',  0x7F, 0x80, 0x8F, 0x90, 0x9F, 0xA0, 0xBF, 0xC0, 0xC1, 0xC2, 0xDF,
                                          0xE0, 0xE1, 0xED, 0xEE, 0xEF, 0xF0, 0xF1, 0xF3, 0xF4, 0xF5, 0xF8, 0xFF};
    uint32_t seed = 1, held = 0;
    for (int i = 0; i < 200000; i++) {
        char text[7] = "";
        const size_t length = next(&seed) % sizeof text;
        for (size_t k = 0; k < length; k++) text[k] = (char)bytes[next(&seed) % sizeof bytes];
        json_t *string = json_string(text);
        assert_int_equal(record_can_hold(text), string != NULL);
        held += string && (text[0] & 0x80) != 0;
        json_decref(string);
    }
    assert_true(held > 1000); /* not of ASCII alone */
}

static void a_record_that_lacks_something_is_none(UNUSED void **state) {
    json_t *object = json_object(), *list = json_array();
    record_set(&object, "a", json_integer(1));
    record_append(&list, json_integer(1));
    assert_int_equal(json_object_size(object), 1);
    assert_int_equal(json_array_size(list), 1);
    record_set(&object, "b", NULL);
    record_append(&list, NULL);
    assert_null(object);
    assert_null(list);
    record_set(&object, "c", json_integer(1));
    record_append(&list, json_integer(1));
    assert_null(object);
    assert_null(list);
    assert_null(record_text(object, 0));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(holds_the_texts_that_jansson_holds),
        cmocka_unit_test(a_record_that_lacks_something_is_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
