#!/usr/bin/python3
"""Renders an array of scan slices from three sides, with one table for all of them.

    PYTHONPATH=build/python python3 apps/examples/slices.py [SLICES.npy]
"""

import sys

import freevoxels
import numpy as np


def made_slices():
    """A skull-like shell with soft matter inside, 1.5 times as far between slices as within them."""
    z, y, x = np.mgrid[-1:1:64j, -1:1:96j, -1:1:96j].astype("float32")
    # One quarter is cut away, to look inside.
    whole = (x < 0) | (y < 0)
    radius = np.sqrt((x / 0.8) ** 2 + (y / 0.9) ** 2 + (z / 0.95) ** 2)
    shell = 1000 * np.exp(-(((radius - 0.85) / 0.08) ** 2))
    return whole * (shell + 150 * (radius < 0.8) * (1 + 0.5 * np.sin(9 * x) * np.sin(8 * y)))


slices = np.load(sys.argv[1]) if len(sys.argv) > 1 else made_slices()
volume = freevoxels.Volume(slices, spacing=(1, 1, 1.5))
print(f"{volume.shape} voxels of {volume.range[0]:g} to {volume.range[1]:g}")

renderer = freevoxels.Renderer(volume, size=(640, 480), up=(0, 0, 1), transfer_function={
    "range": [0, 1000],
    "opacity": [[0.02, 0.0], [0.1, 0.01], [0.3, 0.02], [1.0, 0.2]],
    "color": [[0.0, 0.8, 0.3, 0.2], [0.3, 0.9, 0.6, 0.4], [1.0, 1.0, 0.95, 0.85]],
})
for azimuth in (0, 120, 240):
    image = renderer.render(orbit=(azimuth, 15))
    freevoxels.save(f"slices_{azimuth}.png", image)
    print(f"slices_{azimuth}.png, of which {100 * (image[..., 3] > 0.5).mean():.0f} % are covered")
