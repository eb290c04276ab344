#!/usr/bin/env python3
"""Reads baked volumes without the program's own reader, and compares them with the OpenVDB files that they were baked of."""
import os
import subprocess
import sys
import tempfile
import unittest

import pyopenvdb as vdb

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from fvx_reader import Fvx  # noqa: E402

PROGRAM = os.environ["FREEVOXELS_PROGRAM"]


def run(*arguments):
    subprocess.run([PROGRAM, *arguments, "--quiet"], check=True)


class FvxTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        run("generate", "cloud", cls.path("cloud.vdb"), "--resolution", "48")
        run("bake", cls.path("cloud.vdb"), cls.path("kept.fvx"), "--keep-scalars")
        run("bake", cls.path("cloud.vdb"), cls.path("small.fvx"), "--density-scale", "30")
        grid = vdb.read(cls.path("cloud.vdb"), "density")
        cls.densities = {}
        for item in grid.citerOnValues():
            low, high = item.min, item.max
            for z in range(low[2], high[2] + 1):
                for y in range(low[1], high[1] + 1):
                    for x in range(low[0], high[0] + 1):
                        cls.densities[x, y, z] = item.value

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder.name, name)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def voxels(self, file):
        origin = file.description["index_origin"]
        return {tuple(i + o for i, o in zip(voxel, origin)): v for voxel, v in file.values("scalars").items()}

    def test_kept_scalars_are_the_same_bits(self):
        self.assertEqual(self.voxels(Fvx(self.path("kept.fvx"))), self.densities)

    def test_values_of_16_bits_are_densities_to_a_2048th(self):
        voxels = self.voxels(Fvx(self.path("small.fvx")))
        self.assertEqual(voxels.keys(), self.densities.keys())
        for voxel, density in self.densities.items():
            self.assertAlmostEqual(voxels[voxel], density, delta=density / 2047 + 1e-6)

    def test_index_counts_and_ranges_are_those_of_the_chunks(self):
        file = Fvx(self.path("kept.fvx"))
        chunks = file.chunks("scalars")
        self.assertEqual(sum(chunk["active"] for chunk in chunks), len(self.densities))
        self.assertEqual(max(chunk["maximum"] for chunk in chunks), max(self.densities.values()))
        scale = file.description["classification"]["density_scale"]
        for chunk in chunks:
            self.assertAlmostEqual(chunk["most_extinction"], scale * chunk["maximum"], delta=1e-5 * scale)

    def test_coarser_level_holds_means(self):
        file = Fvx(self.path("kept.fvx"))
        fine, coarse = file.values("scalars"), file.values("scalars", 1)
        size = file.description["dimensions"]
        for voxel, mean in coarse.items():
            below = [tuple(2 * v + (corner >> i & 1) for i, v in enumerate(voxel)) for corner in range(8)]
            inside = [b for b in below if all(c < n for c, n in zip(b, size))]
            self.assertAlmostEqual(mean, sum(fine.get(b, 0.0) for b in inside) / len(inside), places=6)

    def test_provenance_names_the_source_and_the_options(self):
        provenance = Fvx(self.path("small.fvx")).provenance
        self.assertTrue(provenance["options"]["input"].endswith("cloud.vdb"))
        self.assertEqual(provenance["options"]["density-scale"], "30")
        self.assertEqual(provenance["file_bytes"], os.path.getsize(self.path("cloud.vdb")))


if __name__ == "__main__":
    unittest.main()
