"""Reads the images that FreeVoxels writes as .exr, without its own reader: scan lines, compressed with zlib or not at all."""

import struct
import zlib

import numpy as np

TYPES = {0: np.dtype("<u4"), 1: np.dtype("<f2"), 2: np.dtype("<f4")}
LINES = {0: 1, 2: 1, 3: 16}  # of a block, by compression: none, ZIPS, ZIP


def attributes(data):
    """The header's attributes by name, and where it ends."""
    assert data[:4] == b"\x76\x2f\x31\x01", "is no EXR"
    place, found = 8, {}
    while data[place]:
        name, kind = data[place:].split(b"\0", 2)[:2]
        place += len(name) + len(kind) + 2
        (size,) = struct.unpack_from("<i", data, place)
        found[name.decode()] = data[place + 4 : place + 4 + size]
        place += 4 + size
    return found, place + 1


def channel_types(data):
    """The channels in their order in the file."""
    channels, place = {}, 0
    while data[place]:
        name = data[place:].split(b"\0", 1)[0]
        place += len(name) + 1
        channels[name.decode()] = TYPES[struct.unpack_from("<i", data, place)[0]]
        place += 16
    return channels


def unpacked(block, size):
    if len(block) == size:
        return block
    differences = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.int64)
    differences[1:] -= 128
    halves = np.cumsum(differences).astype(np.uint8)
    result = np.empty(size, np.uint8)
    middle = (size + 1) // 2
    result[0::2], result[1::2] = halves[:middle], halves[middle:]
    return result.tobytes()


def read(file):
    """Arrays (height, width) by channel."""
    data = file.read_bytes()
    header, place = attributes(data)
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    lines = LINES[header["compression"][0]]
    types = channel_types(header["channels"])
    images = {name: np.empty((height, width), kind) for name, kind in types.items()}
    for offset in struct.unpack_from(f"<{-(-height // lines)}Q", data, place):
        first, stored = struct.unpack_from("<ii", data, offset)
        rows = range(first - top, min(first - top + lines, height))
        block = unpacked(data[offset + 8 : offset + 8 + stored], len(rows) * width * sum(kind.itemsize for kind in types.values()))
        at = 0
        for row in rows:
            for name, kind in types.items():
                images[name][row] = np.frombuffer(block, kind, width, at)
                at += width * kind.itemsize
    return images
