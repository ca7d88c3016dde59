/* Texts of strangers as they are shown: on one line, and nothing hidden in them. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/common.h"
#include "shown.h"
#include "unit.h"

static const struct {
    const char *text, *shown;
} corpus[] = {
    {"street.exr", "street.exr"},
    {"André – 反射 µ×½ 👁", "André – 反射 µ×½ 👁"},
    {"a\\nb $(x) `y` 'z' \"w\" <b> %s%n", "a\\nb $(x) `y` 'z' \"w\" <b> %s%n"}, /* is data here, and stays it */
    {"\x1b[31mred\x1b]0;title\a", "\\x1b[31mred\\x1b]0;title\\x07"},
    {"two\nlines\r\tand \x7f\b", "two\\nlines\\r\\tand \\x7f\\x08"},
    {"\xc2\x9b"
     "31m \xc2\x80 \xc2\x85 \xc2\x9f",
     "\\u009b31m \\u0080 \\u0085 \\u009f"},
    {"\xc2\xa0"
     "no break",
     "\xc2\xa0"
     "no break"},
    {"gpj\xe2\x80\xae"
     "exe.\xe2\x81\xa6 \xe2\x81\xa9 \xe2\x80\x8f \xd8\x9c",
     "gpj\\u202eexe.\\u2066 \\u2069 \\u200f \\u061c"},
    {"\xe2\x80\xa8 \xe2\x80\xa9 \xef\xbb\xbf \xe2\x80\x8b \xc2\xad", "\\u2028 \\u2029 \\ufeff \\u200b \\u00ad"},
    {"\xf3\xa0\x80\xa1 tag", "\\U000e0021 tag"},
    {"\x80 \xff \xc3", "\\x80 \\xff \\xc3"},                                   /* no UTF-8 */
    {"\xc0\x9b \xe0\x80\x9b", "\\xc0\\x9b \\xe0\\x80\\x9b"},                   /* overlong */
    {"\xed\xa0\x80 \xf4\x90\x80\x80", "\\xed\\xa0\\x80 \\xf4\\x90\\x80\\x80"}, /* a surrogate, beyond Unicode */
    {"cut \xe2\x82", "cut \\xe2\\x82"},
    {"", ""},
};

static void hidden_characters_are_escaped(UNUSED void **state) {
    for (size_t i = 0; i < sizeof corpus / sizeof *corpus; i++) {
        char *copy = shown_copy(corpus[i].text), again[200];
        assert_string_equal(copy, corpus[i].shown);
        assert_true(shown_is_plain(corpus[i].shown));
        assert_int_equal(shown_is_plain(corpus[i].text), !strcmp(corpus[i].text, corpus[i].shown));
        shown_text(again, sizeof again, copy);
        assert_string_equal(again, copy);
        free(copy);
    }
}

static void what_does_not_fit_is_cut_between_characters(UNUSED void **state) {
    char text[8];
    for (size_t room = 1; room <= sizeof text; room++) {
        memset(text, 'x', sizeof text);
        shown_text(text, room, "é\x1bz");
        assert_string_equal(text, room < 3 ? "" : room < 7 ? "é" : room < 8 ? "é\\x1b" : "é\\x1bz");
    }
}

/* A stream hands over its bytes in pieces. */
static void a_character_may_come_in_pieces(UNUSED void **state) {
    const char eye[] = "\xf0\x9f\x91\x81";
    char piece[SHOWN_PIECE];
    for (size_t size = 1; size < 4; size++) assert_int_equal(shown_piece(eye, size, piece), 0);
    assert_int_equal(shown_piece(eye, 4, piece), 4);
    assert_string_equal(piece, eye);
    assert_int_equal(shown_piece("\xf0x", 2, piece), 1);
    assert_string_equal(piece, "\\xf0");
    assert_int_equal(shown_piece("\0", 1, piece), 1);
    assert_string_equal(piece, "\\x00");
}

static void json_stays_the_same_values(UNUSED void **state) {
    char *plain = strdup("{\n \"a\": \"André\\u001b\"\n}"), *same = shown_json(plain);
    assert_ptr_equal(same, plain);
    free(same);
    char *text = shown_json(strdup("[\"\x7f\", \"\xc2\x9b\xe2\x80\xae\", \"\xf3\xa0\x80\xa1\", \"é\"]\n"));
    assert_string_equal(text, "[\"\\u007f\", \"\\u009b\\u202e\", \"\\udb40\\udc21\", \"é\"]\n");
    free(text);
    assert_null(shown_json(NULL));
}

static void messages_have_nothing_hidden(UNUSED void **state) {
    struct glint_error err;
    for (size_t i = 0; i < sizeof corpus / sizeof *corpus; i++) {
        assert_false(glint_fail(&err, GLINT_ERROR_FORMAT, "%s: wrong", corpus[i].text));
        char expected[300];
        snprintf(expected, sizeof expected, "%s: wrong", corpus[i].shown);
        if (strncmp(corpus[i].text, "cut", 3) != 0) assert_string_equal(err.message, expected);
        assert_true(shown_is_plain(err.message));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hidden_characters_are_escaped),  cmocka_unit_test(what_does_not_fit_is_cut_between_characters),
        cmocka_unit_test(a_character_may_come_in_pieces), cmocka_unit_test(json_stays_the_same_values),
        cmocka_unit_test(messages_have_nothing_hidden),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
