#!/usr/bin/env python3
"""Makes the path-traced images of this folder.

  make.py read FILE.vdb FILE.npy       the box of active voxels of the first grid; needs pyopenvdb
  make.py draw FOLDER NAME [SAMPLES]   FOLDER/NAME.exr from FOLDER/VOLUME.npy, as in SCENES; needs mitsuba, and numba for fire
  make.py check FOLDER                 tracer.py, which draws fire, beside Mitsuba, and without scattering beside the integral along rays

FOLDER/cloud.npy is the box of `freevoxels generate cloud cloud.vdb --resolution 48`; smoke.npy and wdas.npy are those of the two files
that README.md names. Fire is made here. Arrays are [x][y][z].
"""
import math
import sys

import numpy as np

EYE, AT, FOV, SIZE = np.array([1.2, 0.8, 1.6]), np.array([0.0, -0.05, 0.0]), 35.0, 96
KEY, BACK, SIDE = (-0.32, 0.85, 0.42), (-0.5, 0.4, -1.0), (1.0, 0.2, -0.3)
PI = math.pi

# volume, extinction per edge at the largest density (at 1 for the cloud), albedo, g, direction to the light, irradiance, samples
SCENES = {
    "cloud_key": ("cloud", 20, 0.99, 0.0, KEY, 4 * PI, 1024),
    "cloud_side": ("cloud", 20, 0.99, 0.0, SIDE, 4 * PI, 1024),
    "cloud_back": ("cloud", 20, 0.99, 0.0, BACK, 4 * PI, 1024),
    "cloud_white": ("cloud", 80, 0.999, 0.0, KEY, 4 * PI, 1024),
    "cloud_g60": ("cloud", 20, 0.99, 0.6, BACK, 4 * PI, 2048),
    "cloud_g60_key": ("cloud", 20, 0.99, 0.6, KEY, 4 * PI, 2048),
    "cloud_g85": ("cloud", 60, 0.99, 0.85, SIDE, 4 * PI, 2048),
    "cloud_sky": ("cloud", 20, 0.99, 0.0, None, 1.0, 2048),
    "cloud_red": ("cloud", 20, (0.99, 0.9, 0.7), 0.0, KEY, 4 * PI, 4096),
    "wdas_key": ("wdas", 40, 0.99, 0.0, KEY, 3.0, 2048),
    "wdas_back": ("wdas", 40, 0.99, 0.0, BACK, 6.0, 1024),
    "wdas_white": ("wdas", 120, 0.999, 0.0, KEY, 3.0, 512),
    "smoke_key": ("smoke", 12 * 5.7148438, 0.99, 0.0, KEY, 8.0, 2048),
    "smoke_back": ("smoke", 12 * 5.7148438, 0.99, 0.0, BACK, 8.0, 2048),
    "fire": ("fire", 12, 0.8, 0.0, None, 0.0, 16384),
}


def read(source, target):
    import pyopenvdb
    grid = pyopenvdb.readAll(source)[0][0]
    low, high = (np.array(corner) for corner in grid.evalActiveVoxelBoundingBox())
    values = np.zeros(high - low + 1, np.float32)
    grid.copyToArray(values, ijk=tuple(int(i) for i in low))
    corners = [grid.transform.indexToWorld(tuple(float(i) for i in corner)) for corner in (low - 0.5, high + 0.5)]
    print("voxels", low, "to", high, "largest", values.max(), "box in the world", *corners)
    np.save(target, values)


def density_of(folder, volume):
    """Densities of voxels of a box around the origin, the longest edge of which is 1."""
    if volume == "fire":
        return clamp_ball(np.zeros(3), 0.45, 0.08)
    values = np.load(f"{folder}/{volume}.npy")
    if volume != "cloud":
        return values / values.max()
    whole = np.zeros((48, 48, 48), np.float32)
    whole[1:46, 10:41, 5:42] = values  # where they are in the cube that was filled
    return whole


def clamp_ball(centre, radius, edge):
    place = np.moveaxis(np.indices((32, 32, 32)), 0, -1) / 32 + (0.5 / 32 - 0.5)
    return np.clip((radius - np.linalg.norm(place - centre, axis=-1)) / edge, 0, 1).astype(np.float32)


def mitsuba():
    import mitsuba as mi
    mi.set_variant("scalar_rgb")
    return mi


def draw_mitsuba(density, scale, albedo, g, light, irradiance, samples, seed=1):
    mi = mitsuba()
    move = mi.ScalarTransform4f
    half = (np.array(density.shape) + 2) / (2 * max(density.shape))
    grid = mi.VolumeGrid(np.ascontiguousarray(np.pad(density, 1).transpose(2, 1, 0))[..., None])
    sensor = {"type": "perspective", "fov": FOV, "fov_axis": "y", "to_world": move().look_at(list(EYE), list(AT), [0, 1, 0]),
              "film": {"type": "hdrfilm", "width": SIZE, "height": SIZE, "pixel_format": "rgb", "component_format": "float32",
                       "rfilter": {"type": "box"}},
              "sampler": {"type": "independent"}}
    medium = {"type": "heterogeneous", "scale": float(scale),
              "albedo": {"type": "rgb", "value": list(np.broadcast_to(albedo, 3).astype(float))},
              "sigma_t": {"type": "gridvolume", "grid": grid, "to_world": move().translate(list(-half)).scale(list(2 * half))},
              "phase": {"type": "hg", "g": g}}
    emitter = {"type": "constant", "radiance": irradiance} if light is None else {
        "type": "directional", "direction": [-x for x in light], "irradiance": irradiance}
    scene = mi.load_dict({
        "type": "scene", "sensor": sensor, "emitter": emitter,
        # The sky is hidden where it is seen without scattering, through the volume too.
        "integrator": {"type": "volpath", "max_depth": 5000, "rr_depth": 2000, "hide_emitters": True},
        "box": {"type": "cube", "to_world": move().scale(list(half)), "bsdf": {"type": "null"}, "interior": medium}})
    return np.array(mi.render(scene, spp=samples, seed=seed))


def frame_of_camera():
    front = (AT - EYE) / np.linalg.norm(AT - EYE)
    right = np.cross(front, [0, 1, 0])
    right /= np.linalg.norm(right)
    return np.array([front, right * math.tan(math.radians(FOV / 2)), np.cross(right, front) * math.tan(math.radians(FOV / 2))])


def draw_tracer(density, scale, albedo, sky, emission, samples):
    import tracer
    extinction = np.pad(density, 1) * float(scale)
    image = tracer.trace(extinction, np.pad(emission, 1), max(density.shape), EYE, frame_of_camera(), SIZE, albedo, sky, samples)
    return np.repeat(image[..., None], 3, 2)


def fire_emission():
    return 30 * clamp_ball(np.array([0.1, -0.1, 0.05]), 0.15, 0.05)


def draw(folder, name, samples=None):
    volume, scale, albedo, g, light, irradiance, usual = SCENES[name]
    density, samples = density_of(folder, volume), int(samples or usual)
    image = (draw_tracer(density, scale, albedo, 0.0, fire_emission(), samples) if volume == "fire"
             else draw_mitsuba(density, scale, albedo, g, light, irradiance, samples))
    print(name, samples, "samples, mean", image.mean((0, 1)), "largest", image.max())
    mitsuba().Bitmap(image.astype(np.float16)).write(f"{folder}/{name}.exr")


def check(folder):
    import tracer
    cloud = density_of(folder, "cloud")
    truth, image = draw_mitsuba(cloud, 20, 0.99, 0.0, None, 1.0, 512), draw_tracer(cloud, 20, 0.99, 1.0, 0 * cloud, 512)
    print("a sky around the cloud: mean of Mitsuba", truth.mean(), "and here", image.mean())
    image = draw_tracer(density_of(folder, "fire"), 12, 0.0, 0.0, fire_emission(), 16384)[..., 0]
    density, emission, frame, step = np.pad(density_of(folder, "fire"), 1) * 12.0, np.pad(fire_emission(), 1), frame_of_camera(), 1 / 256
    sums = np.zeros((SIZE, SIZE))
    for row, column in np.ndindex(SIZE, SIZE):
        d = frame[0] + ((column + 0.5) / SIZE * 2 - 1) * frame[1] + (1 - (row + 0.5) / SIZE * 2) * frame[2]
        d, depth = d / np.linalg.norm(d), 0.0
        for t in np.arange(1.0, 3.2, step):
            x, y, z = (EYE + d * t) * 32 + 16.5
            between = step * tracer.read_at(density, x, y, z)
            sums[row, column] += step * tracer.read_at(emission, x, y, z) * math.exp(-depth - between / 2)
            depth += between
    print("emission without scattering: mean of the integral", sums.mean(), "and here", image.mean())


if __name__ == "__main__":
    {"read": read, "draw": draw, "check": check}[sys.argv[1]](*sys.argv[2:])
