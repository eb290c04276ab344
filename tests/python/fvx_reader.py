"""Reads baked volumes by engine/docs/fvx_format.md alone, for the tests: no code is shared with the writer. Checksums are not checked."""
import ctypes
import json
import struct

IDENTIFIER = bytes.fromhex("ab465658203031bb0d0a1a0a")
NO_DATA = struct.unpack("<f", bytes.fromhex("ffff7fff"))[0]
CHANNELS = {"scalars": 0, "temperature": 1, "albedo": 2}
EDGE, BRICK = 32, 8


def zstd_planes(stored, size, width):
    library = ctypes.CDLL("libzstd.so.1")
    library.ZSTD_decompress.restype = ctypes.c_size_t
    library.ZSTD_decompress.argtypes = (ctypes.c_void_p, ctypes.c_size_t, ctypes.c_char_p, ctypes.c_size_t)
    planes = ctypes.create_string_buffer(size)
    assert library.ZSTD_decompress(planes, size, stored, len(stored)) == size
    values = bytearray(size)
    for plane in range(width):
        values[plane::width] = planes.raw[plane * (size // width):(plane + 1) * (size // width)]
    return bytes(values)


class Fvx:
    def __init__(self, path):
        with open(path, "rb") as file:
            self.bytes = file.read()
        identifier, mark, major, self.minor, count, size, self.hash = struct.unpack_from("<12sIHHIQQ", self.bytes)
        assert identifier == IDENTIFIER and mark == 0x04030201 and major == 1, "no baked volume"
        assert size == len(self.bytes), "incomplete"
        self.sections = {}
        for i in range(count):
            kind, channel, level, _, offset, length, _ = struct.unpack_from("<IIIIQQQ", self.bytes, 128 + 64 * i)
            assert offset % 4096 == 0 and offset + length <= size
            self.sections[kind, channel, level] = (offset, length)
        self.description = json.loads(self._section(1))
        self.provenance = json.loads(self._section(2))

    def _section(self, kind, channel=0, level=0):
        offset, length = self.sections[kind, channel, level]
        return self.bytes[offset:offset + length]

    def chunks(self, channel, level=0):
        """Dictionaries, in the order of the file."""
        names = ("x", "y", "z", "codec", "bricks", "offset", "stored", "size", "hash", "minimum", "maximum", "least_extinction",
                 "most_extinction", "active")
        index = self._section(3, CHANNELS[channel], level)
        return [dict(zip(names, struct.unpack_from("<iiiIQQQQQffffI", index, at))) for at in range(0, len(index), 96)]

    def values(self, channel, level=0):
        """{(x, y, z): value} of voxels with data; of albedos the values are triples. Chunks must not be compressed."""
        encoding = next(c for c in self.description["channels"] if c["name"] == channel)
        form, size = {"float32": ("f", 4), "float16": ("e", 2), "linear16": ("H", 2)}[encoding["encoding"]]
        parts = 3 if channel == "albedo" else 1
        result = {}
        for chunk in self.chunks(channel, level):
            assert chunk["codec"] == 0
            at = chunk["offset"]
            for brick in range(64):
                if not chunk["bricks"] >> brick & 1:
                    continue
                raw = struct.unpack_from(f"<{512 * parts}{form}", self.bytes, at)
                codes = struct.unpack_from(f"<{512 * parts}H", self.bytes, at) if size == 2 else raw
                at += 512 * parts * size
                for i in range(512):
                    value = self._value(encoding, raw[i::512], codes[i::512])
                    if value is None:
                        continue
                    voxel = (EDGE * chunk["x"] + BRICK * (brick % 4) + i % 8,
                             EDGE * chunk["y"] + BRICK * (brick // 4 % 4) + i // 8 % 8,
                             EDGE * chunk["z"] + BRICK * (brick // 16) + i // 64)
                    result[voxel] = value if parts == 3 else value[0]
            assert at == chunk["offset"] + chunk["size"]
        return result

    def dimensions(self, level):
        size = self.description["dimensions"]
        for _ in range(level):
            size = [(n + 1) // 2 for n in size]
        return size

    @staticmethod
    def _value(encoding, raw, codes):
        name = encoding["encoding"]
        if name == "float32":
            return None if raw[0] == NO_DATA else raw
        if name == "float16":
            return None if codes[0] == 0xffff else tuple(v * encoding["scale"] for v in raw)
        return None if codes[0] == 0 else tuple(encoding["offset"] + (c - 1) * encoding["scale"] for c in codes)
