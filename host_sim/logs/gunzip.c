#include "logs/gunzip.h"

#include <string.h>

enum { MAGIC_SIZE = 3, WINDOW_BITS_OF_GZIP = 15 + 16 };

static const unsigned char magic[MAGIC_SIZE] = {0x1F, 0x8B, 0x08};

void gunzip_init(gunzip_t *gunzip) {
    (void)memset(gunzip, 0, offsetof(gunzip_t, buffer));
}

/** Read more behind the bytes that are not used yet. @return false: a failure of the source */
static bool refill(gunzip_t *gunzip, gunzip_source_fn *source, void *ctx) {
    if (gunzip->begin > 0) {
        (void)memmove(gunzip->buffer, &gunzip->buffer[gunzip->begin], gunzip->end - gunzip->begin);
        gunzip->end -= gunzip->begin;
        gunzip->begin = 0;
    }
    const ssize_t count = source(ctx, &gunzip->buffer[gunzip->end], GUNZIP_BUFFER_SIZE - gunzip->end);
    if (count < 0) {
        return false;
    }
    gunzip->at_end = count == 0;
    gunzip->end += (size_t)count;
    return true;
}

/** Read the first bytes and tell what they are. @return false: a failure of the source, or no memory */
static bool begin(gunzip_t *gunzip, gunzip_source_fn *source, void *ctx, const char **wrong) {
    while ((gunzip->end < MAGIC_SIZE) && !gunzip->at_end) {
        if (!refill(gunzip, source, ctx)) {
            return false;
        }
    }
    gunzip->is_packed = (gunzip->end >= MAGIC_SIZE) && (memcmp(gunzip->buffer, magic, MAGIC_SIZE) == 0);
    if (gunzip->is_packed && (inflateInit2(&gunzip->stream, WINDOW_BITS_OF_GZIP) != Z_OK)) {
        gunzip->is_packed = false;
        *wrong = "no memory to unpack it";
        return false;
    }
    gunzip->is_begun = true;
    return true;
}

/** Hand out bytes that are not compressed. */
static ssize_t read_plain(gunzip_t *gunzip, gunzip_source_fn *source, void *ctx, void *bytes, size_t size) {
    size_t count = gunzip->end - gunzip->begin;
    if (count == 0) {
        return gunzip->at_end ? 0 : source(ctx, bytes, size);
    }
    count = (count < size) ? count : size;
    (void)memcpy(bytes, &gunzip->buffer[gunzip->begin], count);
    gunzip->begin += count;
    return (ssize_t)count;
}

/** Unpack what there is. @return what zlib says */
static int unpack(gunzip_t *gunzip, unsigned char *bytes, size_t size, size_t *count) {
    z_stream *stream = &gunzip->stream;
    stream->next_in = &gunzip->buffer[gunzip->begin];
    stream->avail_in = (uInt)(gunzip->end - gunzip->begin);
    stream->next_out = bytes;
    stream->avail_out = (uInt)size;
    const int result = inflate(stream, Z_NO_FLUSH);
    gunzip->begin = gunzip->end - stream->avail_in;
    *count = size - stream->avail_out;
    gunzip->in_member = result != Z_STREAM_END;
    if (result == Z_STREAM_END) {
        (void)inflateReset(stream);
    }
    return result;
}

static ssize_t read_packed(gunzip_t *gunzip, gunzip_source_fn *source, void *ctx, unsigned char *bytes, size_t size,
                           const char **wrong) {
    for (;;) {
        if (gunzip->begin < gunzip->end) {
            size_t count = 0;
            const int result = unpack(gunzip, bytes, size, &count);
            if ((result != Z_OK) && (result != Z_STREAM_END) && (result != Z_BUF_ERROR)) {
                *wrong = "the gzip data is damaged";
                return -1;
            }
            if (count > 0) {
                return (ssize_t)count;
            }
        } else if (gunzip->at_end) {
            gunzip->is_cut_off = gunzip->in_member;
            *wrong = gunzip->in_member ? "the gzip file is cut off" : NULL;
            return gunzip->in_member ? -1 : 0;
        } else if (!refill(gunzip, source, ctx)) {
            return -1;
        }
    }
}

ssize_t gunzip_read(gunzip_t *gunzip, gunzip_source_fn *source, void *ctx, void *bytes, size_t size,
                    const char **wrong) {
    *wrong = NULL;
    if (!gunzip->is_begun && !begin(gunzip, source, ctx, wrong)) {
        return -1;
    }
    return gunzip->is_packed ? read_packed(gunzip, source, ctx, bytes, size, wrong)
                             : read_plain(gunzip, source, ctx, bytes, size);
}

void gunzip_end(gunzip_t *gunzip) {
    if (gunzip->is_packed) {
        (void)inflateEnd(&gunzip->stream);
    }
    gunzip_init(gunzip);
}
