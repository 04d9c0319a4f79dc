/* JUnit XML: what is written, and that it stays XML whatever the text is. */
#include <string.h>

#include "io/junit.h"
#include "scratch.h"
#include "unity.h"

static output_t output;

void setUp(void) {
    scratch_open();
    memset(&output, 0, sizeof output);
    TEST_ASSERT_TRUE(output_open(&output, scratch_path("j.xml")));
}

void tearDown(void) {
    output_discard(&output);
}

static const char *written(void) {
    TEST_ASSERT_TRUE(output_commit(&output));
    return scratch_read("j.xml");
}

void test_a_suite_of_one_that_passed_one_that_failed_and_one_that_could_not_be_run(void) {
    static const char failures[2][16] = {"a < b", "c"};
    junit_begin(&output, "s", 3, 1, 1);
    junit_test(&output, "f.yaml", "one", NULL, 0, 0);
    junit_test(&output, "g.yaml", "two", failures[0], 2, sizeof failures[0]);
    junit_error(&output, "h.yaml", "h.yaml", "a < b");
    junit_end(&output);
    TEST_ASSERT_EQUAL_STRING("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                             "<testsuite name=\"s\" tests=\"3\" failures=\"1\" errors=\"1\" skipped=\"0\">\n"
                             "  <testcase classname=\"f.yaml\" name=\"one\"/>\n"
                             "  <testcase classname=\"g.yaml\" name=\"two\">\n"
                             "    <failure message=\"a &lt; b\">a &lt; b\nc\n</failure>\n"
                             "  </testcase>\n"
                             "  <testcase classname=\"h.yaml\" name=\"h.yaml\">\n"
                             "    <error message=\"a &lt; b\"/>\n"
                             "  </testcase>\n"
                             "</testsuite>\n",
                             written());
}

void test_what_means_something_to_xml_is_escaped(void) {
    junit_text(&output, "<a b=\"c\" d='e'>&amp;\nf\tg</a>");
    TEST_ASSERT_EQUAL_STRING("&lt;a b=&quot;c&quot; d=&apos;e&apos;&gt;&amp;amp;&#10;f\tg&lt;/a&gt;", written());
}

void test_what_xml_cannot_hold_is_a_question_mark(void) {
    /* control character; lone continuation; cut short; overlong; surrogate; U+FFFE; above U+10FFFF; FFh; and good ones */
    junit_text(&output, "\x01|\x80|\xC3|\xC0\xAF|\xED\xA0\x80|\xEF\xBF\xBE|\xF4\x90\x80\x80|\xFF|\xC3\xA9|\xE2\x82\xAC|"
                        "\xF0\x9F\x98\x80");
    TEST_ASSERT_EQUAL_STRING("?|?|?|??|???|???|????|?|\xC3\xA9|\xE2\x82\xAC|\xF0\x9F\x98\x80", written());
}
