#include "logs/log_foreign.h"

#include <stdbool.h>
#include <string.h>
#include <strings.h>

#include "logs/log_token.h"

#define CAN_LOGCONVERT "convert it: python3 -m can.logconvert @ @.log (python-can)"
#define CAN_LOGCONVERT_MDF                                                                                             \
    "convert it: python3 -m can.logconvert @ @.log (python-can[mf4])" /* it finalises a copy, too */
#define EXPORT "export its CAN frames as a candump log or Vector ASC"
/*
 * b() joins bits, lowest first. Columns 6 to 14 are the class of an error frame, 15 to 21 its second byte; the other
 * bytes are lost. What tshark takes for another protocol has no data here, and is left out.
 */
#define TSHARK                                                                                                         \
    "convert it: tshark -r @ -T fields -e{frame.time_epoch,can.{id,len,flags.{xtd,rtr},err.{tx_timeout,lostarb,ctrl,"  \
    "prot,trx,ack,busoff,buserror,restarted,ctrl.{rx_overflow,tx_overflow,rx_warning,tx_warning,rx_passive,"           \
    "tx_passive,active}}},canfd.flags.{brs,esi},data.data}"                                                            \
    " | awk -F'\\t' 'function b(n,m){return n>m?0:2*b(n+1,m)+($n~/[1T]/)} "                                            \
    "$6!=\"\"{printf \"(%.6f) can0 2%07X#00%02X000000000000\\n\",$1,b(6,14),b(15,21);next} "                           \
    "$3!=\"\"&&(b(5,5)||length($24)==2*$3){printf \"(%.6f) can0 \"(b(4,4)?\"%08X\":\"%03X\")\"%s\\n\",$1,$2,"          \
    "b(5,5)?\"#R\"$3:($22!=\"\"?\"##\"b(22,23):\"#\")$24}' > @.log"

/** What a file begins with. */
typedef struct {
    const char *bytes;
    size_t size;
    log_foreign_t format;
} beginning_t;

#define BEGINS(text, name, convert)                                                                                    \
    {                                                                                                                  \
        (text), sizeof(text) - 1, {                                                                                    \
            (name), (convert)                                                                                          \
        }                                                                                                              \
    }

void log_foreign_advice(text_t *text, const log_foreign_t *format, const char *path) {
    static const size_t path_max = 150;
    const char *name = (strlen(path) > path_max) ? "FILE" : path;
    text_add(text, "%s; ", format->name);
    for (const char *at = format->convert; *at != '\0'; at++) {
        const char letter[2] = {*at, '\0'};
        text_add(text, "%s", (*at == '@') ? name : letter);
    }
}

const log_foreign_t *log_foreign_binary(const char *bytes, size_t size) {
    static const beginning_t beginnings[] = {
        BEGINS("LOGG", "a Vector BLF log", CAN_LOGCONVERT),
        BEGINS("MDF     ", "an MDF log", CAN_LOGCONVERT_MDF),
        BEGINS("UnFinMF", "an MDF log that was not finalised", CAN_LOGCONVERT_MDF),
        BEGINS("SQLite format 3", "an SQLite log", CAN_LOGCONVERT),
        BEGINS("\xD4\xC3\xB2\xA1", "a pcap capture", TSHARK),
        BEGINS("\xA1\xB2\xC3\xD4", "a pcap capture", TSHARK),
        BEGINS("\x4D\x3C\xB2\xA1", "a pcap capture", TSHARK),
        BEGINS("\xA1\xB2\x3C\x4D", "a pcap capture", TSHARK),
        BEGINS("\x0A\x0D\x0D\x0A", "a pcapng capture", TSHARK),
        BEGINS("\xFD"
               "7zXZ",
               "compressed with xz", "unpack it: xz -dc @ > @.log"),
        BEGINS("\x28\xB5\x2F\xFD", "compressed with zstd", "unpack it: zstd -dc @ > @.log"),
        BEGINS("\x04\x22\x4D\x18", "compressed with lz4", "unpack it: lz4 -dc @ > @.log"),
        BEGINS("BZh", "compressed with bzip2", "unpack it: bzip2 -dc @ > @.log"),
        BEGINS("PK\x03\x04", "a zip archive", "unpack it: unzip -p @ > @.log"),
        BEGINS("7z\xBC\xAF", "a 7z archive", "unpack it: 7z e -so @ > @.log"),
        BEGINS("\x89HDF", "an HDF5 file", EXPORT),
        BEGINS("#ROSBAG", "a ROS bag", EXPORT),
        BEGINS("\xFF\xFE", "text in UTF-16", "convert it: iconv -f UTF-16 -t UTF-8 @ > @.log"),
        BEGINS("\xFE\xFF", "text in UTF-16", "convert it: iconv -f UTF-16 -t UTF-8 @ > @.log"),
    };
    for (size_t i = 0; i < sizeof beginnings / sizeof beginnings[0]; i++) {
        if ((size >= beginnings[i].size) && (memcmp(bytes, beginnings[i].bytes, beginnings[i].size) == 0)) {
            return &beginnings[i].format;
        }
    }
    return NULL;
}

static size_t count_of(const char *line, size_t length, char character) {
    size_t count = 0;
    for (size_t i = 0; i < length; i++) {
        count += (line[i] == character) ? 1 : 0;
    }
    return count;
}

/** "  can0  43F   [8]  00 ...": candump's screen without time stamps. */
static bool is_plain_screen(const char *line, size_t length) {
    const char *at = line;
    const char *end = &line[length];
    (void)log_token_next(&at, end);
    uint32_t id = 0;
    const bool has_id = log_token_number(log_token_next(&at, end), 16, UINT32_MAX - 1, &id);
    const log_token_t size = log_token_next(&at, end);
    return has_id && (size.length >= 3) && (size.at[0] == '[') && (size.at[size.length - 1] == ']');
}

static bool has(const char *line, size_t length, const char *text) {
    const size_t size = strlen(text);
    bool found = false;
    for (size_t at = 0; !found && (at + size <= length); at++) {
        found = strncasecmp(&line[at], text, size) == 0;
    }
    return found;
}

/** The first lines of PEAK's first version, which does not name itself: comments. */
static bool is_old_trc(const char *line, size_t length) {
    return (length > 0) && (line[0] == ';') &&
           (has(line, length, ";####") || has(line, length, "Start time:") || has(line, length, "PCAN"));
}

const log_foreign_t *log_foreign_text(const char *line, size_t length) {
    static const beginning_t beginnings[] = {
        BEGINS(";$FILEVERSION", "a PEAK TRC log", CAN_LOGCONVERT),
        BEGINS("***BUSMASTER", "a BUSMASTER log", "open @ in SavvyCAN and save it as a candump log, @.log"),
        BEGINS("timestamp,arbitration_id", "a CSV log of python-can", CAN_LOGCONVERT),
        BEGINS("Time Stamp,ID,Extended", "a CSV log of SavvyCAN",
               "open @ in SavvyCAN and save it as a candump log, @.log"),
    };
    static const log_foreign_t plain_screen = {"candump's screen form without time stamps",
                                               "record it again: candump -l can0"};
    static const log_foreign_t colours = {"text with colour codes, as candump -c shows it",
                                          "remove them: sed 's/\\x1B\\[[0-9;]*m//g' @ > @.log"};
    static const log_foreign_t old_trc = {"a PEAK TRC log", CAN_LOGCONVERT};
    static const log_foreign_t csv = {"a CSV file",
                                      "make it one line a frame: (seconds.micros) can0 43F#0000000000000011"};
    for (size_t i = 0; i < sizeof beginnings / sizeof beginnings[0]; i++) {
        if ((length >= beginnings[i].size) && (strncasecmp(line, beginnings[i].bytes, beginnings[i].size) == 0)) {
            return &beginnings[i].format;
        }
    }
    if (memchr(line, '\x1B', length) != NULL) {
        return &colours;
    }
    if (is_old_trc(line, length)) {
        return &old_trc;
    }
    if (is_plain_screen(line, length)) {
        return &plain_screen;
    }
    static const size_t columns = 3;
    const bool is_csv =
        (line[0] != '(') && ((count_of(line, length, ',') >= columns) || (count_of(line, length, ';') >= columns));
    return is_csv ? &csv : NULL;
}
