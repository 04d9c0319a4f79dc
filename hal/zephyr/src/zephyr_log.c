/* hal/store.h: the log of events in flash, a flash circular buffer (FCB) of the partition log-partition. */
#include <string.h>

#include <zephyr/storage/flash_map.h>

#include "zephyr_hal_internal.h"

#if DT_NODE_HAS_PROP(ZEPHYR_HAL_NODE, log_partition)

enum { LOG_AREA = DT_FIXED_PARTITION_ID(DT_PHANDLE(ZEPHYR_HAL_NODE, log_partition)) };

/* FCB writes a header of 8 bytes, so flash with larger write blocks cannot be used. */
enum { LOG_MAGIC = 0x4C564741, BLOCK_MAX = 8, ERASED = 0xFF, CHUNK_WORDS = 16 };

/* Where a length or a header cannot be written, a record goes on: the active sector is closed, and one sector left out. */
enum { SECTORS_LEFT_MAX = 2 };

static struct flash_sector sectors[CONFIG_AGV_LOG_SECTORS];
static struct fcb log_buffer;

/* The header that FCB writes at the start of a sector: 8 bytes. Its version is the number of sectors of the log: a log
 * with another number does not count as this log. */
typedef struct {
    uint32_t magic;
    uint8_t version;
    uint8_t padding;
    uint16_t id;
} head_t;

typedef enum {
    SECTOR_ERASED,
    SECTOR_OF_LOG,
    SECTOR_BEGUN, /* erased behind a header of which only some bits were written: a power cut at the sector's start */
    SECTOR_OTHER  /* any other content: foreign, or the result of a power cut during an erase */
} sector_kind_t;

typedef struct {
    sector_kind_t kind;
    uint16_t id;
} sector_state_t;

static bool is_erased(const struct flash_area *area, const struct flash_sector *sector, size_t from) {
    uint32_t words[CHUNK_WORDS];
    size_t size = 0u;
    for (size_t done = from; done < sector->fs_size; done += size) {
        size = MIN(sizeof words, sector->fs_size - done);
        (void)memset(words, 0, sizeof words);
        if (flash_area_read(area, sector->fs_off + (off_t)done, words, size) != 0) {
            return false;
        }
        for (size_t i = 0u; i < (size / sizeof words[0]); i++) {
            if (words[i] != UINT32_MAX) {
                return false;
            }
        }
    }
    return true;
}

/* Writing only clears bits. So a header that was cut short still has every bit that the complete header has. */
static bool is_begun(const head_t *head, uint32_t count) {
    return ((head->magic & (uint32_t)LOG_MAGIC) == (uint32_t)LOG_MAGIC) && ((head->version & count) == count) &&
           (head->padding == ERASED);
}

static sector_state_t examine(const struct flash_area *area, const struct flash_sector *sector, uint32_t count) {
    sector_state_t state = {.kind = SECTOR_OTHER, .id = 0u};
    head_t head;
    if (flash_area_read(area, sector->fs_off, &head, sizeof head) != 0) {
        return state;
    }
    state.id = head.id;
    /* The identifier FFFFh is that of a torn header only without records: the log counts up to it. */
    if ((head.magic == (uint32_t)LOG_MAGIC) && (head.version == count) &&
        ((head.id != UINT16_MAX) || !is_erased(area, sector, sizeof head))) {
        state.kind = SECTOR_OF_LOG;
    } else if (is_erased(area, sector, 0u)) {
        state.kind = SECTOR_ERASED;
    } else if (is_begun(&head, count) && is_erased(area, sector, sizeof head)) {
        state.kind = SECTOR_BEGUN;
    } else {
        /* other content */
    }
    return state;
}

/* The sector of the log with the latest identifier; `count` when no sector is of the log. */
static uint32_t find_newest(const sector_state_t *states, uint32_t count) {
    uint32_t newest = count;
    for (uint32_t i = 0u; i < count; i++) {
        const bool later = (newest == count) || ((int16_t)(states[i].id - states[newest].id) > 0);
        if ((states[i].kind == SECTOR_OF_LOG) && later) {
            newest = i;
        }
    }
    return newest;
}

/* FCB erases one sector at a time, the one behind the newest; in a log that has gone around, perhaps behind a worn one. */
static bool may_be_torn(const sector_state_t *states, uint32_t count, uint32_t newest, uint32_t sector) {
    const uint32_t next = (newest + 1u) % count;
    const bool is_left_out = (states[next].kind == SECTOR_ERASED) || (states[next].kind == SECTOR_BEGUN);
    return (sector == next) || (is_left_out && (states[newest].id >= count) && (sector == ((next + 1u) % count)));
}

/* Content that is not of the log, and that no power cut explains, is foreign. */
static bool is_foreign(const sector_state_t *states, uint32_t count) {
    const uint32_t newest = find_newest(states, count);
    for (uint32_t i = 0u; i < count; i++) {
        const bool may_be = (newest != count) && may_be_torn(states, count, newest, i);
        if ((states[i].kind == SECTOR_OTHER) && !may_be) {
            return true;
        }
    }
    return false;
}

/*
 * A power cut while a sector is started or erased leaves a sector for which FCB would refuse the whole log, or in which
 * it would write although it is not erased. Such a sector is left out, or, with `repair`, erased: then the processor may
 * stall. Returns the number of usable sectors in `sectors`.
 */
static uint32_t keep_sound(const struct flash_area *area, const sector_state_t *states, uint32_t count, bool repair,
                           bool *all) {
    uint32_t sound = 0u;
    *all = true;
    for (uint32_t i = 0u; i < count; i++) {
        bool broken = (states[i].kind == SECTOR_OTHER) || (states[i].kind == SECTOR_BEGUN);
        if (broken && repair) {
            broken = flash_area_flatten(area, sectors[i].fs_off, sectors[i].fs_size) != 0;
        }
        if (broken) {
            *all = false;
        } else {
            sectors[sound] = sectors[i];
            sound++;
        }
    }
    return sound;
}

/* Find the sectors of the partition. Returns their number, 0 without any. */
static uint32_t find_sectors(void) {
    uint32_t count = ARRAY_SIZE(sectors);
    const int status = flash_area_get_sectors(LOG_AREA, &count, sectors);
    return ((status == 0) || (status == -ENOMEM)) ? count : 0u;
}

static struct flash_sector *sector_after(const struct flash_sector *sector) {
    const uint32_t next = (uint32_t)(sector - log_buffer.f_sectors) + 1u;
    return &log_buffer.f_sectors[next % log_buffer.f_sector_cnt];
}

/* No more records go into the active sector. When it was closed before, the next one cannot be begun: leave that out. */
static void leave_sector(void) {
    struct fcb_entry *const active = &log_buffer.f_active;
    if (active->fe_elem_off == active->fe_sector->fs_size) {
        active->fe_sector = sector_after(active->fe_sector);
    }
    active->fe_elem_off = active->fe_sector->fs_size;
}

/*
 * FCB refuses a newest sector in which the length of a record is torn: it points behind the sector. FCB has found all
 * sectors by then, so the sector is closed and its records stay.
 * FCB begins an empty log in the first sector. A worn one is left out.
 */
static bool open_fcb(uint32_t count, uint32_t sound, bool empty) {
    int status = -EIO;
    for (uint32_t first = 0u; (first < sound) && (status == -EIO); first++) {
        log_buffer = (struct fcb){.f_magic = LOG_MAGIC,
                                  .f_version = (uint8_t)count,
                                  .f_sectors = &sectors[first],
                                  .f_sector_cnt = (uint8_t)(sound - first)};
        status = fcb_init(LOG_AREA, &log_buffer);
        if ((status == -EIO) && (log_buffer.f_active.fe_sector != NULL)) {
            leave_sector();
            status = 0;
        }
        if (!empty) {
            break;
        }
    }
    return status == 0;
}

/* FCB compares identifiers as signed numbers, and takes 7FFFh for newer than 8000h. Then the newest sector is closed. */
static void correct_newest(off_t newest, uint16_t id) {
    for (uint32_t i = 0u; (log_buffer.f_active_id != id) && (i < log_buffer.f_sector_cnt); i++) {
        struct flash_sector *const sector = &log_buffer.f_sectors[i];
        if (sector->fs_off == newest) {
            log_buffer.f_active = (struct fcb_entry){.fe_sector = sector, .fe_elem_off = sector->fs_size};
            log_buffer.f_active_id = id;
            log_buffer.f_oldest = sector_after(sector);
        }
    }
}

volatile bool zephyr_log_is_read;

static zephyr_hal_log_t begin_fcb(const struct flash_area *area, uint32_t count, bool repair, bool *all) {
    static sector_state_t states[CONFIG_AGV_LOG_SECTORS];
    for (uint32_t i = 0u; i < count; i++) {
        states[i] = examine(area, &sectors[i], count);
    }
    if (is_foreign(states, count)) {
        return ZEPHYR_HAL_LOG_FOREIGN;
    }
    const uint32_t newest = find_newest(states, count);
    const off_t begins = (newest != count) ? sectors[newest].fs_off : 0;
    const uint32_t sound = keep_sound(area, states, count, repair, all);
    if (!open_fcb(count, sound, newest == count)) {
        return ZEPHYR_HAL_LOG_FAILED;
    }
    if (newest != count) {
        correct_newest(begins, states[newest].id);
    }
    return ZEPHYR_HAL_LOG_READY;
}

static void open_log(hal_t *hal, bool repair) {
    const struct flash_area *area = NULL;
    hal->log = ZEPHYR_HAL_LOG_FAILED;
    hal->log_is_whole = false;
    if (flash_area_open(LOG_AREA, &area) == 0) {
        zephyr_log_is_read = true;
        hal->log = begin_fcb(area, find_sectors(), repair, &hal->log_is_whole);
        zephyr_log_is_read = false;
        flash_area_close(area);
    }
}

static bool flash_is_suitable(void) {
    const struct flash_area *area = NULL;
    if (flash_area_open(LOG_AREA, &area) != 0) {
        return false;
    }
    const bool fits = (flash_area_align(area) <= BLOCK_MAX) && (flash_area_erased_val(area) == ERASED);
    flash_area_close(area);
    return fits;
}

/* Never erases: broken sectors are repaired by hal_store_append(), which may stall the processor. */
bool zephyr_log_start(hal_t *hal) {
    const bool fits = flash_is_suitable();
    hal->log = ZEPHYR_HAL_LOG_FAILED;
    if (fits) {
        open_log(hal, false);
    }
    return fits;
}

/* Foreign content is never erased here. Only zephyr_hal_log_format() erases it. */
static bool ready(hal_t *hal) {
    if ((hal->log == ZEPHYR_HAL_LOG_FAILED) || ((hal->log == ZEPHYR_HAL_LOG_READY) && !hal->log_is_whole)) {
        open_log(hal, true);
    }
    return hal->log == ZEPHYR_HAL_LOG_READY;
}

static bool erase_sector(uint32_t index) {
    const struct flash_area *area = NULL;
    struct flash_sector all[CONFIG_AGV_LOG_SECTORS];
    uint32_t count = ARRAY_SIZE(all);
    const int status = flash_area_get_sectors(LOG_AREA, &count, all);
    bool erased = ((status == 0) || (status == -ENOMEM)) && (index < count) && (flash_area_open(LOG_AREA, &area) == 0);
    if (erased) {
        erased = flash_area_flatten(area, all[index].fs_off, all[index].fs_size) == 0;
        flash_area_close(area);
    }
    return erased;
}

bool zephyr_hal_log_format(hal_t *hal, uint32_t step) {
    hal->log = ZEPHYR_HAL_LOG_FORMATTING;
    const bool more = erase_sector(step);
    if (!more) {
        open_log(hal, false);
    }
    return more;
}

/* Write whole blocks of the flash. The padding has the value of erased flash. */
static bool write_padded(struct fcb_entry place, const void *record, size_t size) {
    uint8_t padded[HAL_STORE_RECORD_SIZE_MAX];
    const struct flash_area *const area = log_buffer.fap;
    (void)memset(padded, ERASED, sizeof padded);
    (void)memcpy(padded, record, size);
    return flash_area_write(area, FCB_ENTRY_FA_DATA_OFF(place), padded, ROUND_UP(size, flash_area_align(area))) == 0;
}

static int find_room(size_t size, struct fcb_entry *place) {
    int status = fcb_append(&log_buffer, (uint16_t)size, place);
    if (status == -ENOSPC) {
        status = fcb_rotate(&log_buffer);
        status = (status == 0) ? fcb_append(&log_buffer, (uint16_t)size, place) : status;
    }
    return status;
}

bool hal_store_append(hal_t *hal, const void *record, size_t size) {
    struct fcb_entry place;
    if ((size == 0u) || (size > HAL_STORE_RECORD_SIZE_MAX) || !ready(hal)) {
        return false;
    }
    zephyr_log_is_read = true; /* the driver reads what it writes to, and fcb_append_finish() the record */
    int status = find_room(size, &place);
    for (uint32_t i = 0u; (i < SECTORS_LEFT_MAX) && (status == -EIO); i++) {
        leave_sector();
        status = find_room(size, &place);
    }
    const bool stored =
        (status == 0) && write_padded(place, record, size) && (fcb_append_finish(&log_buffer, &place) == 0);
    zephyr_log_is_read = false;
    return stored;
}

static bool copy_record(struct fcb_entry place, void *record, size_t size) {
    const size_t end = place.fe_data_off + ROUND_UP(place.fe_data_len, log_buffer.f_align);
    const size_t copied = MIN(size, place.fe_data_len);
    return (end < place.fe_sector->fs_size) &&
           (flash_area_read(log_buffer.fap, FCB_ENTRY_FA_DATA_OFF(place), record, copied) == 0);
}

/*
 * FCB reports a record that it could not read, because of a torn length or of the flash, as the next one, and never goes
 * on from there: the rest of its sector is left out.
 */
static bool read_next(struct fcb_entry *place, void *record, size_t size) {
    for (uint32_t i = 0u; i <= log_buffer.f_sector_cnt; i++) {
        const struct fcb_entry last = *place;
        if (fcb_getnext(&log_buffer, place) != 0) {
            return false;
        }
        const bool moved = (place->fe_sector != last.fe_sector) || (place->fe_elem_off != last.fe_elem_off);
        if (moved && copy_record(*place, record, size)) {
            return true;
        }
        if (place->fe_sector == log_buffer.f_active.fe_sector) {
            return false;
        }
        *place = (struct fcb_entry){.fe_sector = sector_after(place->fe_sector)};
    }
    return false;
}

size_t zephyr_hal_log_next(hal_t *hal, zephyr_hal_log_cursor_t *cursor, void *record, size_t size) {
    struct fcb_entry *const place = &cursor->place;
    zephyr_log_is_read = true;
    const bool found = (hal->log == ZEPHYR_HAL_LOG_READY) && read_next(place, record, size);
    zephyr_log_is_read = false;
    return found ? place->fe_data_len : 0u;
}

size_t hal_store_read_record(hal_t *hal, uint32_t index, void *record, size_t size) {
    zephyr_hal_log_cursor_t cursor = {0};
    size_t stored = zephyr_hal_log_next(hal, &cursor, record, size);
    for (uint32_t i = 0u; (stored != 0u) && (i < index); i++) {
        stored = zephyr_hal_log_next(hal, &cursor, record, size);
    }
    return stored;
}

#else

volatile bool zephyr_log_is_read;

bool zephyr_log_start(hal_t *hal) {
    hal->log = ZEPHYR_HAL_LOG_NONE;
    return true;
}

bool zephyr_hal_log_format(hal_t *hal, uint32_t step) {
    ARG_UNUSED(hal);
    ARG_UNUSED(step);
    return false;
}

size_t zephyr_hal_log_next(hal_t *hal, zephyr_hal_log_cursor_t *cursor, void *record, size_t size) {
    ARG_UNUSED(hal);
    ARG_UNUSED(cursor);
    ARG_UNUSED(record);
    ARG_UNUSED(size);
    return 0u;
}

bool hal_store_append(hal_t *hal, const void *record, size_t size) {
    ARG_UNUSED(hal);
    ARG_UNUSED(record);
    ARG_UNUSED(size);
    return false;
}

size_t hal_store_read_record(hal_t *hal, uint32_t index, void *record, size_t size) {
    ARG_UNUSED(hal);
    ARG_UNUSED(index);
    ARG_UNUSED(record);
    ARG_UNUSED(size);
    return 0u;
}

#endif
