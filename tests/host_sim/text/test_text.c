#include "text/text.h"

#include "unity.h"

static text_t copy;

void test_what_can_be_shown_stays(void) {
    static const char *const texts[] = {
        "", "my.log", "\xC3\xBC.log", "\xC2\xA0", "\xE2\x82\xAC", "\xEF\xBF\xBD", "\xF0\x9F\x9A\x97", "~ \\\"%s"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(text_is_one_line(texts[i]), texts[i]);
        TEST_ASSERT_EQUAL_STRING(texts[i], text_one_line(&copy, texts[i]));
    }
}

void test_each_byte_of_what_cannot_be_shown_is_a_question_mark(void) {
    static const struct {
        const char *text;
        const char *shown;
    } cases[] = {
        {"a\nb\rc\td", "a?b?c?d"},
        {"\x1B[31m\x7F", "?[31m?"},
        {"\xC2\x80\xC2\x85\xC2\x9F", "??????"},                /* C1: U+0080, U+0085, U+009F */
        {"\xE2\x80\xA8\xE2\x80\xA9\xE2\x80\xAE", "?????????"}, /* U+2028, U+2029, U+202E */
        {"\xEF\xBB\xBF\xEF\xBF\xBE\xEF\xBF\xBF", "?????????"}, /* U+FEFF, U+FFFE, U+FFFF */
        {"\xED\xA0\x80\xF4\x90\x80\x80", "???????"},           /* U+D800, U+110000 */
        {"\xC0\xAF\xE0\x80\xAF\xF0\x80\x80\xAF", "?????????"}, /* longer than need be */
        {"na\xEFve", "na?ve"},
        {"\xE2\x82", "??"},
        {"\xFF\xFE\x80", "???"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        TEST_ASSERT_FALSE_MESSAGE(text_is_one_line(cases[i].text), cases[i].shown);
        TEST_ASSERT_EQUAL_STRING(cases[i].shown, text_one_line(&copy, cases[i].text));
    }
}
