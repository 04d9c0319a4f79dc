/* The log in flash, on the flash simulator: kept and dropped records, a power cut at every write, and worn cells. */
#include <string.h>

#include <zephyr/device.h>
#include <zephyr/drivers/flash.h>
#include <zephyr/drivers/flash/flash_simulator.h>
#include <zephyr/stats/stats.h>
#include <zephyr/storage/flash_map.h>

#include "fixture.h"

enum { RECORD = 108, LONG_RECORD = 200 }; /* about as large as an event of the recorder; with a length of two bytes */

static uint32_t *writes_so_far;
static uint32_t *writes_until_the_cut;
static uint32_t *bytes_of_the_last;
static uint32_t *erases_so_far;

/* The sectors of the log, in the memory of the simulator; and copies, to try the next record in several ways. */
enum { FLASH_MAX = 64 * 1024 };

static uint8_t *flash;
static size_t size;
static size_t sector;
static uint8_t before_it[FLASH_MAX];
static uint8_t after_it[FLASH_MAX];

/* In every file, in place of Zephyr's function: a byte that cannot be written. */
enum { NONE = -1 };
static off_t worn = NONE;
int __real_flash_area_write(const struct flash_area *area, off_t at, const void *from, size_t bytes);
int __wrap_flash_area_write(const struct flash_area *area, off_t at, const void *from, size_t bytes);

int __wrap_flash_area_write(const struct flash_area *area, off_t at, const void *from, size_t bytes) {
    const bool hit = (worn >= at) && (worn < (at + (off_t)bytes));
    return hit ? -EIO : __real_flash_area_write(area, at, from, bytes);
}

static int find(struct stats_hdr *head, void *unused, const char *name, uint16_t offset) {
    static const struct {
        const char *name;
        uint32_t **value;
    } wanted[] = {{"flash_write_calls", &writes_so_far},
                  {"flash_erase_calls", &erases_so_far},
                  {"max_write_calls", &writes_until_the_cut},
                  {"max_len", &bytes_of_the_last}};
    ARG_UNUSED(unused);
    for (size_t i = 0u; i < ARRAY_SIZE(wanted); i++) {
        if (strcmp(name, wanted[i].name) == 0) {
            *wanted[i].value = (uint32_t *)((uint8_t *)head + offset);
        }
    }
    return 0;
}

static void *setup(void) {
    const struct flash_area *area = NULL;
    size_t whole = 0u;
    struct flash_pages_info page;
    (void)stats_walk(stats_group_find("flash_sim_stats"), find, NULL);
    (void)stats_walk(stats_group_find("flash_sim_thresholds"), find, NULL);
    zassert_not_null(writes_until_the_cut);
    zassert_ok(flash_area_open(FIXED_PARTITION_ID(storage_partition), &area));
    flash = (uint8_t *)flash_simulator_get_memory(area->fa_dev, &whole) + area->fa_off;
    zassert_ok(flash_get_page_info_by_offs(area->fa_dev, area->fa_off, &page));
    sector = page.size;
    size = MIN(area->fa_size, CONFIG_AGV_LOG_SECTORS * sector);
    zassert_true(size <= FLASH_MAX, "%u bytes of flash", (unsigned)size);
    flash_area_close(area);
    return NULL;
}

static void erase_all(void) {
    (void)memset(flash, 0xFF, size);
}

static void power_is_back(void) {
    *writes_until_the_cut = 0u;
    (void)fixture_begin();
}

static size_t record_size = RECORD;

static void before(void *unused) {
    record_size = RECORD;
    worn = NONE;
    fixture_before(unused);
    erase_all();
    power_is_back();
}

ZTEST_SUITE(port_log, NULL, setup, before, fixture_after, NULL);

static bool append(uint32_t number) {
    uint8_t record[LONG_RECORD];
    (void)memset(record, (int)(number & 0xFFu), sizeof record);
    (void)memcpy(record, &number, sizeof number);
    return hal_store_append(&hal, record, record_size);
}

/*
 * FCB's checksum has 8 bits, so one of 256 torn records passes it. The content needs its own checksum, as events have.
 */
#define TORN (UINT32_MAX - 1u)

/* The number in a record; UINT32_MAX: no record, TORN: a torn one. */
static uint32_t number_at(uint32_t index) {
    uint8_t record[LONG_RECORD] = {0};
    uint32_t number = UINT32_MAX;
    if (hal_store_read_record(&hal, index, record, sizeof record) == record_size) {
        (void)memcpy(&number, record, sizeof number);
        for (size_t i = sizeof number; i < record_size; i++) {
            number = (record[i] == (uint8_t)number) ? number : TORN;
        }
    }
    return number;
}

static uint32_t count(void) {
    zephyr_hal_log_cursor_t cursor = {0};
    uint8_t record[LONG_RECORD];
    uint32_t records = 0u;
    while (zephyr_hal_log_next(&hal, &cursor, record, sizeof record) == record_size) {
        records++;
    }
    return records;
}

/* Shows: INT-3 */
ZTEST(port_log, test_records_come_back_in_order_and_outlive_a_reset) {
    for (uint32_t i = 0u; i < 20u; i++) {
        zassert_true(append(i));
    }
    power_is_back();
    for (uint32_t i = 0u; i < 20u; i++) {
        zassert_equal(number_at(i), i);
    }
    zassert_equal(number_at(20u), UINT32_MAX);
}

ZTEST(port_log, test_records_of_every_size) {
    uint8_t record[HAL_STORE_RECORD_SIZE_MAX + 1u] = {0};
    zassert_false(hal_store_append(&hal, record, 0u));
    zassert_false(hal_store_append(&hal, record, sizeof record));
    for (size_t length = 1u; length <= HAL_STORE_RECORD_SIZE_MAX; length++) {
        uint8_t read[HAL_STORE_RECORD_SIZE_MAX] = {0};
        (void)memset(record, (int)length, length);
        zassert_true(hal_store_append(&hal, record, length));
        uint32_t index = 0u;
        while (hal_store_read_record(&hal, index + 1u, read, sizeof read) != 0u) {
            index++;
        }
        zassert_equal(hal_store_read_record(&hal, index, read, sizeof read), length);
        zassert_mem_equal(read, record, length);
    }
}

/* Shows: INT-3 */
ZTEST(port_log, test_when_it_is_full_the_oldest_are_dropped) {
    uint32_t kept = 0u;
    for (uint32_t i = 0u; i < 500u; i++) {
        zassert_true(append(i));
    }
    kept = count();
    zassert_true(kept > 10u, "%u", kept);
    for (uint32_t i = 0u; i < kept; i++) {
        zassert_equal(number_at(i), 500u - kept + i);
    }
}

static void put_back(void) {
    (void)memcpy(flash, before_it, size);
    power_is_back();
}

static void cut_this_append(uint32_t number, uint32_t nth, uint32_t bytes) {
    *writes_until_the_cut = *writes_so_far + nth;
    *bytes_of_the_last = bytes;
    (void)append(number);
    power_is_back();
    uint32_t kept = count();
    if ((kept > 0u) && (number_at(kept - 1u) == TORN)) {
        kept--;
    }
    const uint32_t last = (kept > 0u) ? number_at(kept - 1u) : UINT32_MAX;
    zassert_true((last == number) || (last == (number - 1u)), "record %u, write %u, %u bytes: the last is %u", number,
                 nth, bytes, last);
    zassert_equal(number_at(0u), last + 1u - kept, "record %u, write %u, %u bytes: a gap", number, nth, bytes);
    zassert_true(append(number + 1u), "record %u, write %u, %u bytes: it goes on", number, nth, bytes);
    power_is_back();
    zassert_equal(number_at(count() - 1u), number + 1u, "record %u, write %u, %u bytes: and finds it", number, nth,
                  bytes);
}

/* For every record, from an empty log until each sector was reused, in each of its writes. */
static void cut_every_write(void) {
    static const uint32_t bytes[] = {0u, 4u, 1u, 2u, 3u, 5u, 6u, 7u, 8u, 9u, 10u, 24u, 38u, 52u, 66u, 80u, 94u, RECORD};
    const uint32_t erased = *erases_so_far;
    uint32_t cuts = 0u;
    zassert_true(append(0u));
    for (uint32_t number = 1u; (*erases_so_far - erased - cuts) < (uint32_t)CONFIG_AGV_LOG_SECTORS; number++) {
        (void)memcpy(before_it, flash, size);
        const uint32_t written = *writes_so_far;
        zassert_true(append(number));
        const uint32_t writes = *writes_so_far - written;
        const uint32_t erases = *erases_so_far;
        const bool finely = (number == 5u) || (writes > 3u); /* one record, and where a sector is begun or dropped */
        (void)memcpy(after_it, flash, size);
        for (uint32_t nth = 1u; nth <= writes; nth++) {
            for (size_t i = 0u; i < (finely ? ARRAY_SIZE(bytes) : 2u); i++) {
                put_back();
                cut_this_append(number, nth, bytes[i]);
            }
        }
        (void)memcpy(before_it, after_it, size);
        put_back();
        cuts += *erases_so_far - erases; /* erased when the copy was restored */
    }
}

/* Shows: INT-3 */
ZTEST(port_log, test_a_power_cut_in_every_write) {
    cut_every_write();
}

/* Shows: INT-3 */
ZTEST(port_log, test_a_power_cut_in_every_write_of_long_records) {
    record_size = LONG_RECORD;
    cut_every_write();
}

/* The records up to `newest` are there without a gap, at least so many. */
static void assert_kept(uint32_t newest, uint32_t least, const char *what) {
    const uint32_t kept = count();
    zassert_true(kept >= least, "%s, record %u: %u records", what, newest, kept);
    for (uint32_t i = 0u; i < kept; i++) {
        zassert_equal(number_at(i), newest + 1u - kept + i, "%s, record %u: %u at %u", what, newest, number_at(i), i);
    }
}

/* Where the length of the next record is written. */
static size_t place_of_the_next(uint32_t number) {
    size_t place = 0u;
    (void)memcpy(before_it, flash, size);
    zassert_true(append(number));
    while (flash[place] == before_it[place]) {
        place++;
    }
    put_back();
    return place;
}

/* The length 108 is the byte 6Ch. Torn, it still has bit 7, and so a second byte, which is erased. */
/* Shows: INT-3 */
ZTEST(port_log, test_a_torn_length_loses_one_record_only) {
    static const uint8_t torn[] = {0xEC, 0xFE, 0xED, 0xFD};
    for (size_t i = 0u; i < ARRAY_SIZE(torn); i++) {
        erase_all();
        power_is_back();
        for (uint32_t number = 0u; number < 5u; number++) {
            zassert_true(append(number));
        }
        flash[place_of_the_next(5u)] = torn[i];
        power_is_back();
        zassert_equal(hal.log, ZEPHYR_HAL_LOG_READY);
        assert_kept(4u, 5u, "torn");
        for (uint32_t number = 5u; number < 200u; number++) {
            zassert_true(append(number));
            if ((number % 7u) == 0u) {
                assert_kept(number, 5u, "after it");
            }
        }
    }
}

static void assert_that_all_are_stored(off_t cell, const char *what) {
    worn = cell;
    for (uint32_t number = 5u; number < 205u; number++) {
        zassert_true(append(number), "%s: record %u", what, number);
        if ((number % 7u) == 0u) {
            power_is_back();
            assert_kept(number, 5u, what);
        }
    }
}

/* Shows: INT-3 */
ZTEST(port_log, test_a_worn_cell_of_a_length_or_a_header_ends_no_log) {
    for (uint32_t i = 0u; i <= (uint32_t)CONFIG_AGV_LOG_SECTORS; i++) {
        erase_all();
        worn = NONE;
        power_is_back();
        for (uint32_t number = 0u; number < 5u; number++) {
            zassert_true(append(number));
        }
        if (i < (uint32_t)CONFIG_AGV_LOG_SECTORS) {
            assert_that_all_are_stored((off_t)(i * sector), "header");
        } else {
            assert_that_all_are_stored((off_t)place_of_the_next(5u), "length");
        }
    }
}

/* Shows: INT-3 */
ZTEST(port_log, test_an_empty_log_begins_behind_a_worn_header) {
    erase_all();
    worn = 0;
    power_is_back();
    zassert_equal(hal.log, ZEPHYR_HAL_LOG_READY);
    for (uint32_t number = 0u; number < 5u; number++) {
        zassert_true(append(number));
    }
    power_is_back();
    assert_kept(4u, 5u, "begun");
    assert_that_all_are_stored(0, "first header");
}

/* From a sector of this number on: with a reset after each record, each record is kept for as long as without. */
static void go_on_from_sector(uint16_t number) {
    erase_all();
    power_is_back();
    flash[6] = (uint8_t)number;
    flash[7] = (uint8_t)(number >> 8u);
    power_is_back();
    for (uint32_t record = 0u; record < 250u; record++) {
        zassert_true(append(record), "from sector %04x, record %u", number, record);
        const uint32_t kept = count();
        power_is_back();
        zassert_equal(count(), kept, "from sector %04x, record %u", number, record);
        if ((record % 7u) == 0u) {
            assert_kept(record, kept, "from this sector");
        }
    }
}

/* Shows: INT-3 */
ZTEST(port_log, test_the_numbers_of_sectors_wrap) {
    go_on_from_sector(0xFFFEu);
}

/* FCB compares the numbers of sectors as signed ones. */
/* Shows: INT-3 */
ZTEST(port_log, test_the_numbers_of_sectors_pass_the_half) {
    go_on_from_sector(0x7FFEu);
}

/* Possible content of a sector after an interrupted erase. */
static void tear(uint8_t *torn, uint32_t way) {
    const size_t half = sector / 2u;
    if (way == 0u) {
        (void)memset(torn, 0xFF, half);
    } else if (way == 1u) {
        (void)memset(&torn[half], 0xFF, half);
    } else {
        for (size_t i = 0u; i < sector; i++) {
            torn[i] |= (uint8_t)(0x55u << (i % 2u)); /* some bits are erased already */
        }
    }
}

static void assert_that_it_goes_on(uint32_t newest, uint32_t way) {
    uint32_t last = 0u;
    for (uint32_t i = 0u; number_at(i) < TORN; i++) {
        zassert_true((i == 0u) || (number_at(i) > last), "way %u: %u after %u", way, number_at(i), last);
        last = number_at(i);
    }
    zassert_equal(last, newest, "way %u: the newest is %u, not %u", way, last, newest);
    for (uint32_t more = 1u; more <= 40u; more++) {
        zassert_true(append(newest + more), "way %u: record %u more", way, more);
    }
    zassert_true(hal.log_is_whole, "way %u: a sector is lost", way);
    power_is_back();
    zassert_equal(number_at(count() - 1u), newest + 40u, "way %u", way);
}

/* The header of the second sector is worn, so the record behind the first sector is in the third one. */
/* Shows: INT-3 */
ZTEST(port_log, test_a_power_cut_during_an_erase_behind_a_worn_header) {
    uint32_t number = 0u;
    worn = (off_t)sector;
    for (uint32_t rounds = 0u; rounds < 3u; number++) {
        (void)memcpy(before_it, flash, size);
        zassert_true(append(number));
        rounds += (flash[(2u * sector) + 6u] != before_it[(2u * sector) + 6u]) ? 1u : 0u; /* its identifier */
    }
    for (uint32_t way = 0u; way < 3u; way++) {
        (void)memcpy(flash, before_it, size);
        tear(&flash[2u * sector], way);
        power_is_back();
        assert_that_it_goes_on(number - 2u, way);
    }
}

/* For each sector in turn, as the log goes around. */
/* Shows: INT-3 */
ZTEST(port_log, test_a_power_cut_during_an_erase) {
    uint32_t seen = 0u;
    for (uint32_t number = 0u; seen < (uint32_t)CONFIG_AGV_LOG_SECTORS; number++) {
        const uint32_t erased = *erases_so_far;
        (void)memcpy(before_it, flash, size);
        zassert_true(append(number));
        if (*erases_so_far == erased) {
            continue;
        }
        seen++;
        (void)memcpy(after_it, flash, size);
        for (size_t at = 0u; at < size; at += sector) {
            const bool was_erased = (before_it[at] != 0xFFu) && (after_it[at + sector - 1u] == 0xFFu) &&
                                    (memcmp(&before_it[at], &after_it[at], sector) != 0);
            for (uint32_t way = 0u; was_erased && (way < 3u); way++) {
                (void)memcpy(flash, before_it, size);
                tear(&flash[at], way);
                power_is_back();
                assert_that_it_goes_on(number - 1u, way);
            }
        }
        (void)memcpy(before_it, after_it, size);
        put_back();
    }
}

static void assert_foreign_and_unchanged(const char *what) {
    const uint32_t erased = *erases_so_far;
    const uint32_t written = *writes_so_far;
    (void)memcpy(before_it, flash, size);
    power_is_back();
    zassert_equal(hal.log, ZEPHYR_HAL_LOG_FOREIGN, "%s: %d", what, hal.log);
    for (uint32_t i = 0u; i < 5u; i++) {
        zassert_false(append(i), "%s", what);
    }
    zassert_equal(count(), 0u, "%s", what);
    zassert_mem_equal(flash, before_it, size, "%s", what);
    zassert_equal(*erases_so_far, erased, "%s", what);
    zassert_equal(*writes_so_far, written, "%s", what);
}

/* A program, a word at the start of a sector, a sector that is nearly erased. */
/* Shows: INT-3 */
ZTEST(port_log, test_foreign_content_is_never_erased) {
    static const uint8_t flag[] = {0xEF, 0xBE, 0xAD, 0xDE};
    for (size_t i = 0u; i < size; i++) {
        flash[i] = (uint8_t)(i * 7u);
    }
    assert_foreign_and_unchanged("a program");
    for (size_t at = 0u; at < size; at += sector) {
        (void)memset(flash, 0xFF, size);
        (void)memcpy(&flash[at], flag, sizeof flag);
        assert_foreign_and_unchanged("a word");
        (void)memset(flash, 0xFF, size);
        flash[at + sector - 1u] = 0xFEu;
        assert_foreign_and_unchanged("a last byte");
    }
}

/* The log is in its second sector: only the third one may be the result of a power cut. */
/* Shows: INT-3 */
ZTEST(port_log, test_foreign_content_beside_a_log_is_never_erased) {
    for (uint32_t i = 0u; flash[sector] == 0xFFu; i++) {
        zassert_true(append(i));
    }
    (void)memset(flash, 0x5A, sector);
    assert_foreign_and_unchanged("the sector before the newest");
}

/* The version in the header of a sector is the number of the log's sectors. */
/* Shows: INT-3 */
ZTEST(port_log, test_a_log_with_another_number_of_sectors_is_foreign) {
    zassert_true(append(1u));
    zassert_equal(flash[4], CONFIG_AGV_LOG_SECTORS);
    flash[4] = CONFIG_AGV_LOG_SECTORS - 1;
    assert_foreign_and_unchanged("one sector less");
}

/* Shows: INT-3 */
ZTEST(port_log, test_an_operator_can_format_foreign_content) {
    (void)memset(flash, 0x5A, size);
    power_is_back();
    uint32_t erased = 0u;
    while (zephyr_hal_log_format(&hal, erased)) {
        zassert_false(append(0u), "nothing is written meanwhile");
        erased++;
    }
    zassert_equal(erased, CONFIG_AGV_LOG_SECTORS);
    zassert_equal(hal.log, ZEPHYR_HAL_LOG_READY);
    zassert_equal(count(), 0u);
    zassert_true(append(7u));
    power_is_back();
    zassert_equal(number_at(0u), 7u);
}

/* Shows: INT-3 */
ZTEST(port_log, test_the_log_is_read_record_by_record) {
    zephyr_hal_log_cursor_t cursor = {0};
    uint8_t record[RECORD];
    for (uint32_t i = 0u; i < 15u; i++) {
        zassert_true(append(i));
    }
    for (uint32_t i = 0u; i < 15u; i++) {
        zassert_equal(zephyr_hal_log_next(&hal, &cursor, record, sizeof record), RECORD);
        zassert_equal(record[0], i);
    }
    zassert_equal(zephyr_hal_log_next(&hal, &cursor, record, sizeof record), 0u);
}

/* The header of the first sector of an empty log is written at the start. */
/* Shows: INT-3 */
ZTEST(port_log, test_a_power_cut_while_the_first_sector_is_begun) {
    for (uint32_t bytes = 0u; bytes <= 8u; bytes++) {
        erase_all();
        *writes_until_the_cut = *writes_so_far + 1u;
        *bytes_of_the_last = bytes;
        (void)fixture_begin();
        power_is_back();
        zassert_equal(hal.log == ZEPHYR_HAL_LOG_FOREIGN, false, "%u bytes", bytes);
        zassert_true(append(1u), "%u bytes", bytes);
        power_is_back();
        zassert_equal(number_at(0u), 1u, "%u bytes", bytes);
    }
}
