/* hal/store.h: the log of events in flash, a flash circular buffer (FCB) of the partition log-partition. */
#include <string.h>

#include <zephyr/fs/fcb.h>
#include <zephyr/storage/flash_map.h>

#include "zephyr_hal_internal.h"

#if DT_NODE_HAS_PROP(ZEPHYR_HAL_NODE, log_partition)

enum { LOG_AREA = DT_FIXED_PARTITION_ID(DT_PHANDLE(ZEPHYR_HAL_NODE, log_partition)), LOG_VERSION = 1 };

/* FCB writes a header of 8 bytes, so flash with larger write blocks cannot be used. */
enum { LOG_MAGIC = 0x4C564741, BLOCK_MAX = 8, ERASED = 0xFF, CHUNK_WORDS = 16 };

static struct flash_sector sectors[CONFIG_AGV_LOG_SECTORS];
static struct fcb log_buffer;

/* The header that FCB writes at the start of a sector: 8 bytes. */
typedef struct {
    uint32_t magic;
    uint8_t version;
    uint8_t padding;
    uint16_t id;
} head_t;

static bool is_erased(const struct flash_area *area, const struct flash_sector *sector) {
    uint32_t words[CHUNK_WORDS];
    for (size_t done = 0u; done < sector->fs_size; done += sizeof words) {
        if (flash_area_read(area, sector->fs_off + (off_t)done, words, sizeof words) != 0) {
            return false;
        }
        for (size_t i = 0u; i < ARRAY_SIZE(words); i++) {
            if (words[i] != UINT32_MAX) {
                return false;
            }
        }
    }
    return true;
}

/* Broken: neither completely erased nor with a valid header. */
static bool is_broken(const struct flash_area *area, const struct flash_sector *sector) {
    head_t head;
    if (flash_area_read(area, sector->fs_off, &head, sizeof head) != 0) {
        return true;
    }
    const bool whole = (head.magic == (uint32_t)LOG_MAGIC) && (head.version == LOG_VERSION) && (head.id != UINT16_MAX);
    return !whole && !is_erased(area, sector);
}

/*
 * A power cut while a sector is started or erased can leave an invalid header, for which FCB would refuse the whole
 * log. It can also leave an erased header in a sector that is not erased, in which FCB would then write. Such a sector
 * is left out, or, with `repair`, erased: then the processor may stall. Returns the number of usable sectors in
 * `sectors`.
 */
static uint32_t find_sectors(const struct flash_area *area, bool repair, bool *all) {
    uint32_t count = ARRAY_SIZE(sectors);
    uint32_t sound = 0u;
    const int status = flash_area_get_sectors(LOG_AREA, &count, sectors);
    *all = true;
    for (uint32_t i = 0u; ((status == 0) || (status == -ENOMEM)) && (i < count); i++) {
        bool broken = is_broken(area, &sectors[i]);
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

static void open_log(hal_t *hal, bool repair) {
    const struct flash_area *area = NULL;
    hal->log_ready = false;
    hal->log_is_whole = false;
    if (flash_area_open(LOG_AREA, &area) == 0) {
        const uint32_t count = find_sectors(area, repair, &hal->log_is_whole);
        flash_area_close(area);
        log_buffer = (struct fcb){
            .f_magic = LOG_MAGIC, .f_version = LOG_VERSION, .f_sectors = sectors, .f_sector_cnt = (uint8_t)count};
        hal->log_ready = (count > 0u) && (fcb_init(LOG_AREA, &log_buffer) == 0);
    }
}

/* Never erases: broken sectors are repaired by hal_store_append(), which may stall the processor. */
bool zephyr_log_start(hal_t *hal) {
    const struct flash_area *area = NULL;
    if (flash_area_open(LOG_AREA, &area) != 0) {
        return false;
    }
    const bool fits = (flash_area_align(area) <= BLOCK_MAX) && (flash_area_erased_val(area) == ERASED);
    flash_area_close(area);
    if (fits) {
        open_log(hal, false);
    }
    return fits;
}

static bool ready(hal_t *hal) {
    if (!hal->log_ready || !hal->log_is_whole) {
        open_log(hal, true);
    }
    return hal->log_ready;
}

/* Write whole blocks of the flash. The padding has the value of erased flash. */
static bool write_padded(struct fcb_entry place, const void *record, size_t size) {
    uint8_t padded[HAL_STORE_RECORD_SIZE_MAX];
    const struct flash_area *const area = log_buffer.fap;
    (void)memset(padded, ERASED, sizeof padded);
    (void)memcpy(padded, record, size);
    return flash_area_write(area, FCB_ENTRY_FA_DATA_OFF(place), padded, ROUND_UP(size, flash_area_align(area))) == 0;
}

bool hal_store_append(hal_t *hal, const void *record, size_t size) {
    struct fcb_entry place;
    if ((size == 0u) || (size > HAL_STORE_RECORD_SIZE_MAX) || !ready(hal)) {
        return false;
    }
    int status = fcb_append(&log_buffer, (uint16_t)size, &place);
    if (status == -ENOSPC) {
        status = fcb_rotate(&log_buffer);
        status = (status == 0) ? fcb_append(&log_buffer, (uint16_t)size, &place) : status;
    }
    return (status == 0) && write_padded(place, record, size) && (fcb_append_finish(&log_buffer, &place) == 0);
}

size_t hal_store_read_record(hal_t *hal, uint32_t index, void *record, size_t size) {
    struct fcb_entry place = {0};
    bool found = hal->log_ready && (fcb_getnext(&log_buffer, &place) == 0);
    for (uint32_t i = 0u; found && (i < index); i++) {
        found = fcb_getnext(&log_buffer, &place) == 0;
    }
    const size_t copied = found ? MIN(size, place.fe_data_len) : 0u;
    found = found && (flash_area_read(log_buffer.fap, FCB_ENTRY_FA_DATA_OFF(place), record, copied) == 0);
    return found ? place.fe_data_len : 0u;
}

#else

bool zephyr_log_start(hal_t *hal) {
    ARG_UNUSED(hal);
    return true;
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
