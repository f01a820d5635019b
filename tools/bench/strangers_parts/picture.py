"""Whether a picture shows anything, read from its PNG."""
import struct
import zlib

# Two pixels beside each other in a smooth sky or on a ground differ by less than this.
EDGE = 4


def rows(path):
    """The rows of an 8-bit PNG of any colour type without a palette, as bytes, and the bytes of a pixel."""
    data, at, body = path.read_bytes(), 8, b''
    while at < len(data):
        length, kind = struct.unpack('>I4s', data[at:at + 8])
        content = data[at + 8:at + 8 + length]
        if kind == b'IHDR':
            width, height, bits, colour_type, _, _, interlaced = struct.unpack('>IIBBBBB', content)
            if bits != 8 or interlaced or colour_type == 3:
                raise ValueError(f'{path}: a PNG of another kind')
            pixel = {0: 1, 2: 3, 4: 2, 6: 4}[colour_type]
        elif kind == b'IDAT':
            body += content
        at += length + 12
    raw, stride, above = zlib.decompress(body), width * pixel, bytes(width * pixel)
    for y in range(height):
        kind = raw[y * (stride + 1)]
        above = plain(kind, bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)]), above, pixel)
        yield above, pixel


def plain(kind, row, above, pixel):
    """Takes a filter of PNG away (section 9 of its specification)."""
    for x in range(len(row) if kind else 0):
        left = row[x - pixel] if x >= pixel else 0
        up = above[x]
        if kind == 1:
            guess = left
        elif kind == 2:
            guess = up
        elif kind == 3:
            guess = (left + up) // 2
        else:
            corner = above[x - pixel] if x >= pixel else 0
            base = left + up - corner
            guess = min((abs(base - left), 0, left), (abs(base - up), 1, up), (abs(base - corner), 2, corner))[2]
        row[x] = (row[x] + guess) & 255
    return bytes(row)


def shows_something(path):
    """False if no pixel differs from a neighbour by more than the sky does: the picture is empty, or all one surface."""
    before = None
    for row, pixel in rows(path):
        if any(abs(a - b) >= EDGE for a, b in zip(row, row[pixel:])):
            return True
        if before is not None and any(abs(a - b) >= EDGE for a, b in zip(row, before)):
            return True
        before = row
    return False
