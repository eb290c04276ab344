"""A path tracer of volumes that shine, which Mitsuba 3.9 leaves out. make.py uses it."""
import math

import numba
import numpy as np


@numba.njit
def read_at(values, x, y, z):
    """Trilinear, between voxel centres; `values` has a voxel of zeros around."""
    i, j, k = int(math.floor(x)), int(math.floor(y)), int(math.floor(z))
    if min(i, j, k) < 0 or i + 1 >= values.shape[0] or j + 1 >= values.shape[1] or k + 1 >= values.shape[2]:
        return 0.0
    sum = 0.0
    for a in range(2):
        for b in range(2):
            for c in range(2):
                weight = (x - i if a else 1 - x + i) * (y - j if b else 1 - y + j) * (z - k if c else 1 - z + k)
                sum += weight * values[i + a, j + b, k + c]
    return sum


@numba.njit(parallel=True)
def trace(extinction, emission, edge, eye, frame, size, albedo, sky, samples):
    """Isotropic scattering with null collisions: emission counts at each collision, the sky where a path that has scattered leaves."""
    image = np.zeros((size, size))
    most = extinction.max()
    hx, hy, hz = extinction.shape[0] / (2 * edge), extinction.shape[1] / (2 * edge), extinction.shape[2] / (2 * edge)
    for row in numba.prange(size):
        np.random.seed(row + 1)
        for column in range(size):
            sum = 0.0
            for _ in range(samples):
                right, up = (column + np.random.random()) / size * 2 - 1, 1 - (row + np.random.random()) / size * 2
                dx = frame[0, 0] + right * frame[1, 0] + up * frame[2, 0]
                dy = frame[0, 1] + right * frame[1, 1] + up * frame[2, 1]
                dz = frame[0, 2] + right * frame[1, 2] + up * frame[2, 2]
                length = math.sqrt(dx * dx + dy * dy + dz * dz)
                dx, dy, dz = dx / length, dy / length, dz / length
                x, y, z = eye[0], eye[1], eye[2]
                near, far = 0.0, np.inf
                for start, step, end in ((x, dx, hx), (y, dy, hy), (z, dz, hz)):
                    a, b = (-end - start) / step, (end - start) / step
                    near, far = max(near, min(a, b)), min(far, max(a, b))
                if near >= far:
                    continue
                x, y, z = x + near * dx, y + near * dy, z + near * dz
                scattered = False
                while True:
                    step = -math.log(1 - np.random.random()) / most
                    x, y, z = x + step * dx, y + step * dy, z + step * dz
                    if abs(x) > hx or abs(y) > hy or abs(z) > hz:
                        sum += sky if scattered else 0.0
                        break
                    i, j, k = (x + hx) * edge - 0.5, (y + hy) * edge - 0.5, (z + hz) * edge - 0.5
                    sum += read_at(emission, i, j, k) / most
                    if np.random.random() * most >= read_at(extinction, i, j, k):
                        continue
                    if np.random.random() >= albedo:
                        break
                    scattered = True
                    dz, angle = 2 * np.random.random() - 1, 2 * math.pi * np.random.random()
                    dx, dy = math.sqrt(1 - dz * dz) * math.cos(angle), math.sqrt(1 - dz * dz) * math.sin(angle)
            image[row, column] = sum / samples
    return image
