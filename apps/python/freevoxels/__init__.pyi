"""Types of the package `freevoxels` for editors and type checkers; the functions' own documentation is that of help(freevoxels).

The keywords of options are those of apps/scenes/README.md, which gives their units, ranges and defaults, with _ in place of -. Each also
takes the text of the command line (size="640x420"). An object of a section's name, as load_scene() returns it, holds the options of that
section: camera={"orbit": (35, 25)}.
"""

from collections.abc import Callable, Iterator, Mapping
from collections.abc import Sequence as Sequence_
from os import PathLike
from typing import Any, Literal, TypedDict, overload

from numpy import float32
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Unpack

__version__: str

_Path = str | PathLike[str]
_Number = float  # in classes with a keyword `float`
_Numbers = Sequence_[float] | NDArray[Any] | str
_Pair = _Numbers
_Triple = _Numbers  # (x, y, z), or linear (red, green, blue)
_Section = Mapping[str, Any]
_Image = NDArray[float32]  # (height, width, 4): linear, premultiplied
_Depth = NDArray[float32]  # (height, width)
_Channels = dict[str, NDArray[float32]]  # (height, width), or (height, width, 3) of vectors
_Progress = Callable[[str, float], object]  # (stage, fraction of the image that is done, 0 to 1)

class _Part(TypedDict, total=False):  # which part of a file is read
    grid: str
    resolution: int | _Triple
    clip_box: _Numbers
    clip_plane: _Numbers
    raw: str
    series: str
    time_step: int
    pyramid_level: int
    input: _Section

class _Input(_Part, total=False):
    volume: _Path
    spacing: float | Sequence_[float] | NDArray[Any]
    no_data: float | Literal["none"] | None

class _Volumes(TypedDict, total=False):
    volumes: Sequence_[_Path | Volume | Mapping[str, Any]]  # others in the same image: a file, a volume, or its options with "volume" and "transform"

class _Camera(TypedDict, total=False):
    orbit: _Pair
    camera_position: _Triple
    look_at: _Triple
    up: _Triple
    fov: float
    orthographic: float
    flight: _Path | Mapping[str, Any]  # a file, or {"keys": [{"time": 0, "camera-position": (x, y, z), "look-at": (x, y, z)}, ...]}
    size: Sequence_[int] | NDArray[Any] | str
    frames: int
    holdout: _Path | ArrayLike  # depths (height, width) in memory for render() alone
    camera: _Section

class _Classification(TypedDict, total=False):
    density_scale: float
    albedo: _Triple
    albedo_grid: str
    transfer_function: _Path | Mapping[str, Any]  # a preset's name, a file, "FILE:NAME", or an object
    window: _Pair  # (center, width), or "LO..HI"
    opacity: float
    invert: bool
    classification: Literal["post", "pre"] | _Section
    iso: _Numbers
    labels: _Numbers
    channels: str | Sequence_[str]

class _Emission(TypedDict, total=False):
    emission: bool | float | Literal["none"] | _Section
    temperature_grid: str
    temperature_scale: float
    temperature_offset: float

class _Light(TypedDict, total=False):
    light: Mapping[str, Any] | str | Sequence_[Mapping[str, Any] | str]  # one light, several of them, or the section
    lights: Sequence_[Mapping[str, Any] | str]
    unlit: bool
    ambient: float | _Triple
    environment: _Path
    environment_rotation: float
    environment_intensity: float
    extinction_tint: _Triple
    phase_g: float
    light_attenuation: Literal["table", "exact", "auto"]
    shading: Literal["auto", "scatter", "gradient"]
    surface_share: float
    scattering: int | Literal["all"]

class _Method(TypedDict, total=False):
    mode: Literal["volume", "mip", "average"]
    slice: str | tuple[Literal["x", "y", "z"], float | str]
    annotate: bool
    draw: Literal["gather", "splats"]
    composite: Literal["normalised", "additive", "sorted"]
    attenuation: Literal["bilinear", "nearest"]
    directions: Literal[26, 98]
    code: Literal["depth8", "linear8"]
    path_length_correction: bool
    gradient: bool
    lod: float
    quality: float
    culling: bool
    cull_threshold: float
    hierarchy_filter: Literal["geometric", "arithmetic"]
    paper: bool
    method: _Section

class _Output(TypedDict, total=False):
    background: _Triple | Literal["transparent"]
    exposure: _Number
    tone_map: Literal["none", "filmic", "aces"]
    float: bool
    png_bits: Literal[8, 16]
    aov: str | Mapping[str, ArrayLike]
    crop: Sequence_[int] | NDArray[Any] | str
    output: _Section

class _Device(TypedDict, total=False):
    device: str  # part of a device's name, or its number in `freevoxels devices`
    memory_limit: int  # MiB of device memory

class _SceneFile(TypedDict, total=False):
    scene: _Path  # supplies what the other keywords leave out

class _FrameOptions(_Volumes, _Camera, _Classification, _Emission, _Light, _Method, _Device, _SceneFile, total=False):
    output: _Section  # has no effect, but belongs to a whole scene

class _RendererOptions(_FrameOptions, total=False):
    input: _Section  # has no effect, but belongs to a whole scene

class _OpenOptions(_Input, _FrameOptions, total=False): ...

class _OnceOptions(_Part, _FrameOptions, total=False):
    spacing: float | Sequence_[float] | NDArray[Any]
    origin: Sequence_[float] | NDArray[Any]
    transform: ArrayLike | None
    no_data: float | Literal["none"] | None
    temperature: ArrayLike | None

class _SceneOptions(_Input, _Volumes, _Camera, _Classification, _Emission, _Light, _Method, _Output, _SceneFile, total=False): ...

class _BakeOptions(_Input, _Classification, _Emission, _SceneFile, total=False):
    origin: Sequence_[float] | NDArray[Any]
    transform: ArrayLike | None
    temperature: ArrayLike | None

class _SequenceOptions(_Input, _FrameOptions, total=False): ...
class _FilmOptions(_Input, _FrameOptions, _Output, total=False): ...

class Error(Exception):
    parameters: tuple[str, ...]  # the keywords that the sentence names

class UsageError(Error, ValueError): ...
class InputError(Error, ValueError): ...
class OutputError(Error, OSError): ...
class DeviceError(Error, RuntimeError): ...
class OutOfMemoryError(Error, MemoryError): ...

class Volume:
    def __init__(
        self,
        array: ArrayLike,
        *,
        spacing: float | Sequence_[float] | NDArray[Any] = ...,
        origin: Sequence_[float] | NDArray[Any] = ...,
        transform: ArrayLike | None = ...,
        no_data: float | Literal["none"] | None = ...,
        temperature: ArrayLike | None = ...,
        clip_box: _Numbers | None = ...,
        clip_plane: _Numbers | None = ...,
        labels: _Numbers | None = ...,
        channel: str | Sequence_[str] | None = ...,
        input: _Section | None = ...,
    ) -> None: ...
    @staticmethod
    def open(file: _Path | None = ..., **kwargs: Unpack[_OpenOptions]) -> Volume: ...
    @property
    def shape(self) -> tuple[int, int, int]: ...
    @property
    def range(self) -> tuple[float, float]: ...
    @property
    def active_voxels(self) -> int: ...
    @property
    def origin(self) -> tuple[float, float, float]: ...
    @property
    def source(self) -> str: ...

class Renderer:
    def __init__(self, volume: Volume, **kwargs: Unpack[_RendererOptions]) -> None: ...
    @overload
    def render(
        self, *, progress: _Progress | None = ..., depth: Literal[False] = ..., aov: None = ...,
        budget: float | None = ..., **kwargs: Unpack[_RendererOptions]
    ) -> _Image: ...
    @overload
    def render(
        self, *, progress: _Progress | None = ..., depth: Literal[True], aov: None = ...,
        budget: float | None = ..., **kwargs: Unpack[_RendererOptions]
    ) -> tuple[_Image, _Depth]: ...
    @overload
    def render(
        self, *, progress: _Progress | None = ..., depth: Literal[False] = ..., aov: str | Sequence_[str],
        budget: float | None = ..., **kwargs: Unpack[_RendererOptions]
    ) -> tuple[_Image, _Channels]: ...
    @overload
    def turntable(
        self,
        frames: int,
        *,
        progress: _Progress | None = ...,
        depth: Literal[False] = ...,
        aov: None = ...,
        **kwargs: Unpack[_RendererOptions],
    ) -> Iterator[_Image]: ...
    @overload
    def turntable(
        self, frames: int, *, progress: _Progress | None = ..., depth: Literal[True], aov: None = ..., **kwargs: Unpack[_RendererOptions]
    ) -> Iterator[tuple[_Image, _Depth]]: ...
    @overload
    def turntable(
        self,
        frames: int,
        *,
        progress: _Progress | None = ...,
        depth: Literal[False] = ...,
        aov: str | Sequence_[str],
        **kwargs: Unpack[_RendererOptions],
    ) -> Iterator[tuple[_Image, _Channels]]: ...
    @property
    def camera(self) -> dict[str, Any] | None: ...
    @property
    def timings(self) -> list[tuple[str, float]]: ...
    @property
    def device(self) -> str: ...

_Frames = range | int | str | None  # "A-B:STEP"

class Sequence:
    def __init__(
        self,
        volume: _Path | Sequence_[_Path] | None = ...,
        *,
        frames: _Frames = ...,
        fixed_view: bool | None = ...,
        **kwargs: Unpack[_SequenceOptions],
    ) -> None: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[_Image]: ...
    @overload
    def render(
        self, frame: int, *, progress: _Progress | None = ..., depth: Literal[False] = ..., aov: None = ..., **kwargs: Unpack[_RendererOptions]
    ) -> _Image: ...
    @overload
    def render(
        self, frame: int, *, progress: _Progress | None = ..., depth: Literal[True], aov: None = ..., **kwargs: Unpack[_RendererOptions]
    ) -> tuple[_Image, _Depth]: ...
    @overload
    def render(
        self,
        frame: int,
        *,
        progress: _Progress | None = ...,
        depth: Literal[False] = ...,
        aov: str | Sequence_[str],
        **kwargs: Unpack[_RendererOptions],
    ) -> tuple[_Image, _Channels]: ...
    @property
    def files(self) -> list[str]: ...
    @property
    def numbers(self) -> list[float]: ...
    @property
    def camera(self) -> dict[str, Any] | None: ...
    @property
    def timings(self) -> list[tuple[str, float]]: ...
    @property
    def device(self) -> str: ...

@overload
def render(
    volume: ArrayLike | _Path | Volume | Sequence_[ArrayLike | _Path | Volume | Mapping[str, Any]] | None = ...,
    *,
    progress: _Progress | None = ...,
    depth: Literal[False] = ...,
    aov: None = ...,
    **kwargs: Unpack[_OnceOptions],
) -> _Image: ...
@overload
def render(
    volume: ArrayLike | _Path | Volume | Sequence_[ArrayLike | _Path | Volume | Mapping[str, Any]] | None = ...,
    *,
    progress: _Progress | None = ...,
    depth: Literal[True],
    aov: None = ...,
    **kwargs: Unpack[_OnceOptions],
) -> tuple[_Image, _Depth]: ...
@overload
def render(
    volume: ArrayLike | _Path | Volume | Sequence_[ArrayLike | _Path | Volume | Mapping[str, Any]] | None = ...,
    *,
    progress: _Progress | None = ...,
    depth: Literal[False] = ...,
    aov: str | Sequence_[str],
    **kwargs: Unpack[_OnceOptions],
) -> tuple[_Image, _Channels]: ...
def render_sequence(
    volume: _Path | Sequence_[_Path] | None,
    images: _Path | Sequence_[_Path],
    *,
    frames: _Frames = ...,
    fixed_view: bool | None = ...,
    skip_existing: bool = ...,
    progress: _Progress | None = ...,
    **kwargs: Unpack[_FilmOptions],
) -> list[str]: ...
def load_scene(file: _Path) -> dict[str, Any]: ...
def save_scene(file: _Path, **kwargs: Unpack[_SceneOptions]) -> None: ...
def save(file: _Path, image: ArrayLike, *, depth: ArrayLike | None = ..., **kwargs: Unpack[_Output]) -> None: ...
def bake(
    volume: ArrayLike | _Path | Volume | None,
    file: _Path,
    *,
    keep_scalars: bool = ...,
    compress: bool = ...,
    progress: _Progress | None = ...,
    **kwargs: Unpack[_BakeOptions],
) -> None: ...
def convert(volume: _Path, file: _Path, *, progress: _Progress | None = ..., **kwargs: Unpack[_Input]) -> None: ...
def info(volume: _Path, *, check: bool = ..., **kwargs: Unpack[_Input]) -> dict[str, Any]: ...
def merge(parts: _Path | Sequence_[_Path], images: _Path | Sequence_[_Path], **kwargs: Unpack[_Output]) -> None: ...
def devices() -> list[dict[str, Any]]: ...
def presets() -> dict[str, dict[str, Any]]: ...
