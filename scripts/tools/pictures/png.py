"""A PNG with at most 256 colours: a third of the bytes for a picture of text and lines. Python's own library alone."""
import collections
import struct
import zlib

SIGNATURE = b"\x89PNG\r\n\x1a\n"


def _chunks(data):
    at = len(SIGNATURE)
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        yield kind, data[at + 8:at + 8 + length]
        at += 12 + length


def _chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def _paeth(left, up, corner):
    distances = ((abs(up - corner), left), (abs(left - corner), up), (abs(left + up - 2 * corner), corner))
    return min(distances, key=lambda one: one[0])[1]


def _rows(data, width, channels):
    """The rows of a picture of 8 bits, without the filters of PNG."""
    stride = width * channels
    before = bytearray(stride)
    for begin in range(0, len(data), stride + 1):
        kind, row = data[begin], bytearray(data[begin + 1:begin + 1 + stride])
        for i in range(stride if kind else 0):
            left = row[i - channels] if i >= channels else 0
            corner = before[i - channels] if i >= channels else 0
            row[i] = (row[i] + (0, left, before[i], (left + before[i]) // 2, _paeth(left, before[i], corner))[kind]) & 255
        yield row
        before = row


def with_palette(data):
    """The same picture with a palette of its most frequent colours; the others become the nearest of them."""
    parts = list(_chunks(data))
    width, height, depth, colour = struct.unpack(">IIBB", parts[0][1][:10])
    channels = {2: 3, 6: 4}[colour]
    assert depth == 8
    packed = zlib.decompress(b"".join(body for kind, body in parts if kind == b"IDAT"))
    rows = [[(row[i] & 0xFC, row[i + 1] & 0xFC, row[i + 2] & 0xFC) for i in range(0, len(row), channels)]
            for row in _rows(packed, width, channels)]
    counts = collections.Counter(pixel for row in rows for pixel in row)
    palette = [pixel for pixel, _ in counts.most_common(256)]
    index = {pixel: i for i, pixel in enumerate(palette)}
    for pixel in counts:
        if pixel not in index:
            index[pixel] = min(range(len(palette)), key=lambda i: sum((a - b) ** 2 for a, b in zip(palette[i], pixel)))
    lines = b"".join(b"\0" + bytes(index[pixel] for pixel in row) for row in rows)
    whole = b"".join(bytes(min(part | part >> 6, 255) for part in pixel) for pixel in palette)
    return (SIGNATURE + _chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)) + _chunk(b"PLTE", whole)
            + _chunk(b"IDAT", zlib.compress(lines, 9)) + _chunk(b"IEND", b""))
