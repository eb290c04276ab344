"""Renders volumes with shadows, on a GPU or on the CPU."""

import ctypes

from freevoxels import _cpu_driver

# Before the first image: the compiled module opens libvulkan.so.1, which is then the one that is open already.
_loader = _cpu_driver.offer()
if _loader is not None:
    ctypes.CDLL(str(_loader))

from freevoxels._core import (
    DeviceError,
    Error,
    InputError,
    OutOfMemoryError,
    OutputError,
    Renderer,
    Sequence,
    UsageError,
    Volume,
    __doc__,
    __version__,
    bake,
    convert,
    devices,
    info,
    load_scene,
    merge,
    presets,
    render,
    render_sequence,
    save,
    save_scene,
)

__all__ = [
    "DeviceError",
    "Error",
    "InputError",
    "OutOfMemoryError",
    "OutputError",
    "Renderer",
    "Sequence",
    "UsageError",
    "Volume",
    "bake",
    "convert",
    "devices",
    "info",
    "load_scene",
    "merge",
    "presets",
    "render",
    "render_sequence",
    "save",
    "save_scene",
]

del ctypes
