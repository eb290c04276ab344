"""Arrays that the package zarr writes, read back. Skipped without it."""

import gzip
import pathlib
import tempfile
import unittest

import freevoxels
import numpy as np

try:
    import zarr
except ImportError:
    zarr = None

AXES = [{"name": "c", "type": "channel"}] + [{"name": name, "type": "space", "unit": "micrometer"} for name in "zyx"]
DATASETS = [{"path": "0", "coordinateTransformations": [{"type": "scale", "scale": [1, 2, 0.5, 0.5]}]}]


def values_of(nrrd):
    """The values of a file that freevoxels.convert() wrote."""
    header, packed = nrrd.read_bytes().split(b"\n\n", 1)
    sizes = next(line for line in header.split(b"\n") if line.startswith(b"sizes:"))
    return np.frombuffer(gzip.decompress(packed), "<f4").reshape([int(size) for size in sizes.split()[:0:-1]])


@unittest.skipIf(zarr is None or not hasattr(zarr, "create_group"), "the package zarr, version 3, is not installed")
class ZarrTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.array = np.random.default_rng(1).integers(0, 60000, (2, 9, 20, 33)).astype("u2")

    def expect(self, name, version, **keywords):
        group = zarr.create_group(self.folder / name, zarr_format=version)
        group.create_array("0", shape=self.array.shape, dtype=self.array.dtype, **keywords)[:] = self.array
        image = {"version": "0.4", "axes": AXES, "datasets": DATASETS}
        group.attrs.update({"multiscales": [image]} if version == 2 else {"ome": {"version": "0.5", "multiscales": [image]}})
        for channel in (0, 1):
            freevoxels.convert(self.folder / name, self.folder / "a.nrrd", grid=str(channel), no_data="none")
            np.testing.assert_array_equal(values_of(self.folder / "a.nrrd"), self.array[channel].astype("float32"), name)

    def test_hierarchies_of_version_2(self):
        self.expect("default.zarr", 2, chunks=(1, 4, 8, 16))
        self.expect("plain.zarr", 2, chunks=(1, 4, 8, 16), compressors=None)
        self.expect("fortran.zarr", 2, chunks=(2, 9, 20, 33), order="F")

    def test_hierarchies_of_version_3(self):
        from zarr.codecs import BloscCodec, GzipCodec

        self.expect("default.zarr", 3, chunks=(1, 4, 8, 16))
        self.expect("shards.zarr", 3, chunks=(1, 3, 4, 11), shards=(2, 9, 8, 33))
        self.expect("blosc.zarr", 3, chunks=(1, 4, 8, 16), compressors=BloscCodec(cname="lz4", shuffle="bitshuffle"))
        self.expect("gzip.zarr", 3, chunks=(1, 4, 8, 16), compressors=GzipCodec())


if __name__ == "__main__":
    unittest.main()
