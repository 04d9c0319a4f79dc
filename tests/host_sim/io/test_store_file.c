/* What outlives a reset, as a file: read back as written, and never trusted when it is damaged. */
#include "io/store_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "agv/state.h"
#include "scratch.h"
#include "unity.h"

static sim_store_t *store;
static sim_store_t *loaded;
static agv_recorder_t *recorder;
static agv_recorder_t *loaded_recorder;
static output_t *output;

void setUp(void) {
    scratch_open();
    store = calloc(1, sizeof *store);
    loaded = calloc(1, sizeof *loaded);
    recorder = calloc(1, sizeof *recorder);
    loaded_recorder = calloc(1, sizeof *loaded_recorder);
    output = calloc(1, sizeof *output);
    sim_store_init(store);
    agv_recorder_start(recorder);
}

void tearDown(void) {
    output_discard(output);
    free(store);
    free(loaded);
    free(recorder);
    free(loaded_recorder);
    free(output);
}

static void fill(void) {
    const agv_entry_t entry = {.kind = AGV_EVENT_STATE, .b = AGV_STATE_INIT, .state = AGV_STATE_INIT};
    agv_recorder_add(recorder, &entry, 17);
    TEST_ASSERT_TRUE(sim_store_write_latch(store, "12345678", 8));
    TEST_ASSERT_TRUE(sim_store_append(store, "first", 5));
    TEST_ASSERT_TRUE(sim_store_append(store, "second", 6));
}

static void save(void) {
    TEST_ASSERT_TRUE(output_open(output, scratch_path("s")));
    store_file_save(output, store, recorder);
    TEST_ASSERT_TRUE(output_commit(output));
}

static void load(void) {
    TEST_ASSERT_TRUE(store_file_load(scratch_path("s"), loaded, loaded_recorder));
    TEST_ASSERT_EQUAL_STRING("", scratch_said());
}

static bool latch_is_damaged(void) {
    uint8_t latch[HAL_STORE_LATCH_SIZE_MAX] = {0};
    return sim_store_read_latch(loaded, latch, sizeof latch) == sizeof latch && latch[0] == 0xA5;
}

/* Shows: FSM-7 */
void test_what_is_saved_is_loaded(void) {
    fill();
    save();
    load();
    uint8_t bytes[16] = {0};
    TEST_ASSERT_EQUAL_UINT(8, sim_store_read_latch(loaded, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_MEMORY("12345678", bytes, 8);
    TEST_ASSERT_EQUAL_UINT(5, sim_store_read_record(loaded, 0, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_MEMORY("first", bytes, 5);
    TEST_ASSERT_EQUAL_UINT(6, sim_store_read_record(loaded, 1, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_UINT(0, sim_store_read_record(loaded, 2, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_MEMORY(recorder, loaded_recorder, sizeof *recorder);
}

void test_a_store_that_is_full(void) {
    uint8_t record[SIM_STORE_RECORD_SIZE_MAX];
    for (unsigned i = 0; i < SIM_STORE_RECORDS_MAX + 3; i++) {
        memset(record, (int)(i & 0xFFu), sizeof record);
        TEST_ASSERT_TRUE(sim_store_append(store, record, sizeof record));
    }
    save();
    load();
    TEST_ASSERT_EQUAL_UINT(SIM_STORE_RECORDS_MAX, loaded->count);
    TEST_ASSERT_EQUAL_UINT(sizeof record, sim_store_read_record(loaded, 0, record, sizeof record));
    TEST_ASSERT_EQUAL_HEX8(3, record[0]);
    TEST_ASSERT_EQUAL_UINT(0, loaded->latch_size);
}

void test_a_file_that_is_not_there_is_an_empty_store(void) {
    load();
    TEST_ASSERT_EQUAL_UINT(0, loaded->latch_size);
    TEST_ASSERT_EQUAL_UINT(0, loaded->count);
}

/* Shows: FSM-7 */
void test_a_store_that_was_cut_off_anywhere_is_not_trusted(void) {
    fill();
    save();
    static char text[SCRATCH_TEXT_MAX];
    (void)snprintf(text, sizeof text, "%s", scratch_read("s"));
    const size_t size = strlen(text);
    TEST_ASSERT_TRUE(size < SCRATCH_TEXT_MAX - 1);
    for (size_t cut = 0; cut < size; cut += (cut < 100 || cut > size - 100) ? 1 : 4999) {
        (void)scratch_write("s", text, cut);
        load();
        TEST_ASSERT_TRUE(latch_is_damaged());
    }
}

/* Shows: FSM-7 */
void test_a_store_that_was_changed_anywhere_is_not_trusted(void) {
    fill();
    save();
    static char text[SCRATCH_TEXT_MAX];
    (void)snprintf(text, sizeof text, "%s", scratch_read("s"));
    const size_t size = strlen(text);
    for (size_t at = 0; at < size; at += (at < 100 || at > size - 100) ? 1 : 4999) {
        for (unsigned bit = 0; bit < 8; bit += 3) {
            text[at] = (char)(text[at] ^ (1 << bit));
            (void)scratch_write("s", text, size);
            load();
            TEST_ASSERT_TRUE(latch_is_damaged());
            text[at] = (char)(text[at] ^ (1 << bit));
        }
    }
}

void test_what_is_no_store_at_all(void) {
    static const char *const texts[] = {"\n",
                                        "x",
                                        "agv-store 1\n",
                                        "agv-store 2\ncheck 00000000\n",
                                        "agv-store 1\nlatch \ncheck 00000000\n",
                                        "agv-store 1\ncheck 12345678\nlatch 00\n"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        (void)scratch_write("s", texts[i], strlen(texts[i]));
        load();
        TEST_ASSERT_TRUE_MESSAGE(latch_is_damaged(), texts[i]);
    }
}

void test_a_file_of_another_kind_is_not_replaced(void) {
    static const char *const stores[] = {"", "a", "agv-store", "agv-store 1\n", "agv-store x"};
    static const char *const others[] = {"\n", "x", "agv-stork 1\n", "agv_store 1\n"};
    TEST_ASSERT_TRUE(store_file_may_replace(scratch_path("s")));
    for (size_t i = 0; i < sizeof stores / sizeof stores[0]; i++) {
        (void)scratch_write("s", stores[i], strlen(stores[i]));
        TEST_ASSERT_TRUE_MESSAGE(store_file_may_replace(scratch_path("s")), stores[i]);
    }
    TEST_ASSERT_EQUAL_STRING("", scratch_said());
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        (void)scratch_write("s", others[i], strlen(others[i]));
        TEST_ASSERT_FALSE_MESSAGE(store_file_may_replace(scratch_path("s")), others[i]);
        TEST_ASSERT_NOT_NULL(strstr(scratch_said(), "not a store file (it does not begin with 'agv-store ')"));
    }
}

void test_more_after_the_end_is_damage(void) {
    fill();
    save();
    static char text[SCRATCH_TEXT_MAX + 16];
    (void)snprintf(text, sizeof text, "%srecord 00\n", scratch_read("s"));
    (void)scratch_write("s", text, strlen(text));
    load();
    TEST_ASSERT_TRUE(latch_is_damaged());
}

void test_what_cannot_be_read(void) {
    TEST_ASSERT_FALSE(store_file_load("/", loaded, loaded_recorder));
    TEST_ASSERT_EQUAL_STRING("host_sim: /: Is a directory\n", scratch_said());
    TEST_ASSERT_FALSE(store_file_load("/dev/null/a", loaded, loaded_recorder));
    TEST_ASSERT_EQUAL_STRING("host_sim: /dev/null/a: Not a directory\n", scratch_said());
}
