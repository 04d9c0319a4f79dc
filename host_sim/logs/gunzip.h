/**
 * @file gunzip.h
 * Bytes of a file that may be compressed with gzip: told by its first bytes, unpacked as a stream. Several compressed
 * files one after the other (`cat a.gz b.gz`) are read as one.
 */
#ifndef HOST_SIM_GUNZIP_H
#define HOST_SIM_GUNZIP_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>
#include <zlib.h>

#define GUNZIP_BUFFER_SIZE 65536u

/** Read at most @p size bytes. @return number of bytes; 0: the end; -1: a failure */
typedef ssize_t gunzip_source_fn(void *ctx, void *bytes, size_t size);

/** Start from gunzip_init(), or all zero. Some 64 KiB. */
typedef struct {
    bool is_begun;
    bool is_packed;
    bool at_end;    /**< of the source */
    bool in_member; /**< within a compressed file: the end of the source would cut it off */
    bool is_cut_off;
    z_stream stream;
    size_t begin; /**< of the bytes that were read but not used, in `buffer` */
    size_t end;
    unsigned char buffer[GUNZIP_BUFFER_SIZE];
} gunzip_t;

/** Nothing read yet: what was in it is forgotten. */
void gunzip_init(gunzip_t *gunzip);

/**
 * Read on.
 * @param[out] wrong a phrase for a message if the compressed data is damaged or cut off; else NULL
 * @return number of bytes; 0: the end; -1: a failure of the source, or `*wrong`
 */
ssize_t gunzip_read(gunzip_t *gunzip, gunzip_source_fn *source, void *ctx, void *bytes, size_t size,
                    const char **wrong);

/** Free what it holds; it is as after gunzip_init() then. */
void gunzip_end(gunzip_t *gunzip);

#endif
