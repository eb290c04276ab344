#!/usr/bin/python3
"""Draws a film with a camera that moves: a puff that rises and thins out, one file a frame, seen as the film as a whole.

    PYTHONPATH=build/python python3 apps/examples/film.py ['PATTERN_####.vdb']
"""

import sys

import freevoxels
import numpy as np


def bake_frames(pattern, count):
    """A ball that grows and rises; of the frames only the changing part is stored, so that their boxes have different sizes."""
    for number in range(1, count + 1):
        radius, height = 6 + 2 * number, 5 * number
        z, y, x = np.ogrid[-radius : radius + 1, -radius : radius + 1, -radius : radius + 1]
        distance = np.sqrt(x * x + y * y + z * z) / radius
        puff = np.clip(1 - distance, 0, 1) * (1 + 0.4 * np.sin(0.9 * x) * np.sin(0.7 * y + number)) * (12 / radius) ** 3
        freevoxels.bake(puff.astype("float32"), pattern.replace("####", f"{number:04}"), origin=(-radius, height - radius, -radius),
                        no_data=0, density_scale=0.2)


if len(sys.argv) < 2:
    bake_frames("puff_####.fvx", 6)
film = freevoxels.Sequence(sys.argv[1] if len(sys.argv) > 1 else "puff_####.fvx", size=(320, 240))
for place, (file, number) in enumerate(zip(film.files, film.numbers)):
    image = film.render(place, orbit=(30 + 4 * place, 10))
    freevoxels.save(f"film_{number:04}.png", image)
    print(f"{file}: film_{number:04}.png, of which {100 * (image[..., 3] > 0.1).mean():.0f} % are covered")
