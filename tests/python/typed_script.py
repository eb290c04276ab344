"""A user's script that type checkers accept in full, and that runs: every function and class of the package, and mistakes that must be found.

numpy_2_test.py has mypy check it. Each `type: ignore` names a mistake; where mypy misses one, it reports the comment as unused."""

import os
import pathlib
import tempfile
from collections.abc import Iterator
from typing import Any

import freevoxels
import numpy as np
from numpy.typing import NDArray


def report(stage: str, fraction: float) -> None:
    assert stage and 0 <= fraction <= 1


def draw(folder: pathlib.Path) -> None:
    array = np.ones((8, 9, 10), np.uint8)
    volume = freevoxels.Volume(array, spacing=(1, 1, 2.5), origin=[0, 0, 0], no_data=0, clip_box=(0, 0, 0, 9, 8, 15))
    shape: tuple[int, int, int] = volume.shape
    least, most = volume.range
    total: float = least + most + volume.active_voxels + sum(volume.origin) + sum(shape)
    assert volume.source and total > 0
    opened: freevoxels.Volume = freevoxels.Volume.open("procedural:cloud", resolution=16, emission=False)
    freevoxels.Volume([[[1.0, 2.0], [3.0, 4.0]]], transform=np.eye(4), temperature=[[[1.0, 2.0], [3.0, 4.0]]])

    renderer = freevoxels.Renderer(volume, size=(24, 16), density_scale=0.1, light=[{"direction": (1, 1, 1)}, "direction=1,0,0"])
    image: NDArray[np.float32] = renderer.render(orbit=[35, 25], progress=report)
    image, depth = renderer.render(orbit=np.array([35, 25]), depth=True)
    assert image.shape == (16, 24, 4) and depth.shape == (16, 24)
    turn: Iterator[NDArray[np.float32]] = renderer.turntable(2, light={"direction": (1, 2, 1)}, ambient=0.3)
    assert len(list(turn)) == 2
    for frame, distance in renderer.turntable(frames=1, depth=True):
        assert frame.shape[:2] == distance.shape
    camera: dict[str, Any] | None = renderer.camera
    timings: list[tuple[str, float]] = renderer.timings
    assert camera is not None and timings and renderer.device

    for size in ((24, 16), [24, 16], np.array([24, 16]), "24x16"):
        image = freevoxels.render(array, size=size, spacing=np.array([1, 1, 2]), transfer_function={"opacity": [[0, 0], [1, 1]]}, unlit=True)
        assert image.shape == (16, 24, 4)
    image = freevoxels.render(opened, camera={"orbit": (35, 25)}, size=(24, 16))
    image, depth = freevoxels.render("procedural:cloud", resolution=16, size=[24, 16], depth=True)

    film = freevoxels.Sequence(["procedural:cloud", "procedural:shells"], resolution=16, size=(24, 16), fixed_view=True)
    assert len(film) == 2 and film.files[0] == "procedural:cloud" and film.numbers == [0, 1]
    for image in film:
        assert image.shape == (16, 24, 4)
    image, depth = film.render(1, depth=True, orbit=(35, 25))
    written: list[str] = freevoxels.render_sequence(film.files, folder / "film_#.png", resolution=16, size="24x16", exposure=1.5)
    assert len(written) == 2

    freevoxels.bake(array, folder / "array.fvx", spacing=(1, 1, 2.5), keep_scalars=True, density_scale=0.1, progress=report)
    facts: dict[str, Any] = freevoxels.info(folder / "array.fvx", check=True)
    found: list[dict[str, Any]] = freevoxels.devices()
    presets: dict[str, dict[str, Any]] = freevoxels.presets()
    assert facts["levels"] and found and presets
    try:
        freevoxels.convert("procedural:cloud", folder / "cloud.nrrd", resolution=8, progress=lambda stage, fraction: None)
        freevoxels.merge([folder / "array.fvx"], folder / "merged.png", exposure=1)
    except freevoxels.UsageError:
        pass

    scene = folder / "scene.json"
    freevoxels.save_scene(scene, volume="procedural:cloud", resolution=16, size=(24, 16), exposure=1.5)
    sections: dict[str, Any] = freevoxels.load_scene(os.fspath(scene))
    freevoxels.save(folder / "image.exr", freevoxels.render(**sections), float=True)
    freevoxels.save(str(folder / "image.png"), image, depth=None, background=(1, 1, 1), tone_map="filmic", png_bits=16)


def fail() -> None:
    errors: list[type[freevoxels.Error]] = [
        freevoxels.UsageError, freevoxels.InputError, freevoxels.OutputError, freevoxels.DeviceError, freevoxels.OutOfMemoryError]
    assert all(issubclass(error, Exception) for error in errors)
    try:
        freevoxels.render(np.ones((2, 2, 2)), size=3.5)  # type: ignore[call-overload]
    except freevoxels.Error as error:
        parameters: tuple[str, ...] = error.parameters
        assert parameters == ("size",)
    for mistaken in (lambda: freevoxels.Renderer([1, 2]),  # type: ignore[arg-type]
                     lambda: freevoxels.Volume.open("procedural:cloud", resolutoin=16),  # type: ignore[call-arg]
                     lambda: freevoxels.render([[[1.0, 2.0]]], background=(0, 0, 0)),  # type: ignore[call-overload]
                     lambda: freevoxels.save("image.png")):  # type: ignore[call-arg]
        try:
            mistaken()
        except (freevoxels.Error, TypeError):
            continue
        raise AssertionError("a mistake was accepted")


if __name__ == "__main__":
    version: str = freevoxels.__version__
    assert version
    fail()
    with tempfile.TemporaryDirectory() as scratch:
        draw(pathlib.Path(scratch))
