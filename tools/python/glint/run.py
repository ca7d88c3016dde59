"""Runs: the folders that `glint replay` writes, with run.json and one EXR file a pass."""
import ctypes
import json
import os
from typing import Any, NamedTuple, get_type_hints

import numpy as np
from numpy.typing import NDArray

from glint.capture import ARRAY_BYTES, Path
from glint.library import Error, enum, function, path_bytes, string, struct, text

_open = function("glint_exr_open", "path limits")
_close = function("glint_exr_close", "exr")
_count = function("glint_exr_part_count", "exr")
_part = function("glint_exr_part", "exr i")
_read = function("glint_exr_read", "exr part channels count type out threads")
struct("glint_exr_part_info", "name width height channels channel_count")

_STORED = {value: name for name, value in enum("glint_stored").items()}
_TYPES: dict[str, tuple[np.dtype[Any], int]] = {stored: (np.dtype(kind), enum("glint_type")[name]) for stored, kind, name in (
    ("half", "f2", "f16"), ("float", "f4", "f32"), ("uint", "u4", "u32"))}
_FORMAT = 1
_JSON_BYTES = 1 << 24


class Times(NamedTuple):
    """How long a pass took in the timed rounds, nanoseconds. What kind of time it is says `run.json["device"]["times_are"]`.
    cold: no round came before, so that the time includes costs of the first use."""
    n: int
    min: int
    median: int
    max: int
    cold: bool


class Image:
    """An image that a pass wrote.

    name           "travelled", "depth_half", coarser levels "depth_pyramid.level1"
    slot, variant  of the pass
    channels       list of names: ["R", "G", "B"]
    unit, meaning  of its values, as the pass declares them
    width, height  texels; cube maps have six faces below each other for each map
    format         on the device: "R32F", "RGBA16F", "R8UI"
    file, part     where its texels are: a file of the folder, and the name of its part
    """

    def __init__(self, folder: str, slot: str, variant: str, record: Any) -> None:
        where = f"{folder}/run.json: slot {slot}: an image"
        self._folder = folder
        self.slot, self.variant = slot, variant
        self.name = _field(record, "name", str, where)
        where += f": {self.name}"
        self.channels: list[str] = _field(record, "channels", str, where).split()
        self.unit = _field(record, "unit", str, where)
        self.meaning = _field(record, "meaning", str, where)
        self.width = _field(record, "width", int, where)
        self.height = _field(record, "height", int, where)
        self.format = _field(record, "format", str, where)
        self.file = _field(record, "file", str, where)
        self.part = _field(record, "part", str, where)
        if not self.name or not 1 <= len(self.channels) <= 4 or not 1 <= self.width <= 1 << 16 or not 1 <= self.height <= 1 << 19:
            raise Error("format", f"{where}: expected a name, 1 to 4 channels and a size")
        if not self.file or "/" in self.file or self.file[0] == ".":
            raise Error("format", f"{where}: expected the name of a file in the folder, found {self.file!r}")

    def __repr__(self) -> str:
        return f"<Image {self.slot}/{self.name}: {self.width} × {self.height}, {' '.join(self.channels)}, {self.unit}>"

    def read(self, *, array_bytes: int = ARRAY_BYTES, threads: int = 0) -> NDArray[Any]:
        """The texels as stored: float16, float32, or uint32 where the format on the device is one of integers.

        The shape is (height, width), or (height, width, n) where the image has n > 1 channels; row 0 is the top. The array is new and belongs
        to the caller. Raises Error, also where the file is not as run.json says, or the array would be larger than `array_bytes`.
        """
        path = os.path.join(self._folder, self.file)
        exr = _open(path_bytes(path), None)
        try:
            return self._read_from(exr, path, array_bytes, threads)
        finally:
            _close(ctypes.byref(exr))

    def _read_from(self, exr: Any, path: str, array_bytes: int, threads: int) -> NDArray[Any]:
        parts = [_part(exr, i).contents for i in range(_count(exr))]
        at = next((i for i, part in enumerate(parts) if string(part.name) == self.part), None)
        if at is None:
            raise Error("format", f"{path}: part {self.part}: missing")
        part = parts[at]
        if (part.width, part.height) != (self.width, self.height):
            raise Error("format", f"{path}: part {self.part}: expected {self.width} x {self.height}, found {part.width} x {part.height}")
        stored = {string(c.name): _STORED[c.stored.value] for c in part.channels[:part.channel_count]}
        kinds = {stored.get(name, "") for name in self.channels}
        if "" in kinds or len(kinds) > 1:
            raise Error("format", f"{path}: part {self.part}: expected channels {' '.join(self.channels)} of one type, found "
                        + ", ".join(f"{name} {kind}" for name, kind in stored.items()))
        dtype, kind = _TYPES[kinds.pop()]
        size = self.width * self.height * len(self.channels) * dtype.itemsize
        if size > array_bytes:
            raise Error("limit", f"{path}: part {self.part}: expected at most {array_bytes} bytes, found {size}")
        if not 0 <= threads <= 1024:
            raise ValueError(f"threads: expected 0 to 1024, found {threads}")
        out: NDArray[Any] = np.empty((self.height, self.width, len(self.channels)), dtype)
        names = (ctypes.c_char_p * len(self.channels))(*map(text, self.channels))
        _read(exr, at, names, len(self.channels), kind, out.ctypes.data_as(ctypes.c_void_p), threads)
        return out[:, :, 0] if len(self.channels) == 1 else out


class Pass:
    """A pass of the pipeline, whether it ran or not.

    slot, variant  "screen_trace", "hiz"
    ran            False: the plan left it out
    reason         why it ran or did not; None: no reason was needed
    parameters     dict of bool, int, float or str by name
    time           Times, or None if it was not timed
    images         list of Image that are in the folder, finest level first
    record         everything that run.json says about it, as json.load returns it
    """

    def __init__(self, folder: str, record: Any) -> None:
        where = f"{folder}/run.json: a pass"
        self.slot = _field(record, "slot", str, where)
        where = f"{folder}/run.json: slot {self.slot}"
        self.variant = _field(record, "variant", str, where)
        self.ran = _field(record, "ran", bool, where)
        reason = record.get("reason")
        self.reason = None if reason is None else _field(record, "reason", str, where)
        self.parameters: dict[str, Any] = _field(record, "parameters", dict, where)
        time = record.get("time_ns")
        self.time = None if time is None else Times(*(_field(time, key, kind, f"{where}: time_ns") for key, kind in get_type_hints(Times).items()))
        self.images = [Image(folder, self.slot, self.variant, image) for image in _field(record, "images", list, where)]
        self.record: dict[str, Any] = record

    def __repr__(self) -> str:
        return f"<Pass {self.slot}/{self.variant}: {'ran' if self.ran else 'did not run'}>"


def _field(record: Any, key: str, kind: Any, where: str) -> Any:
    value = record.get(key) if isinstance(record, dict) else None
    if not isinstance(value, kind) or (kind is int and isinstance(value, bool)):
        raise Error("format", f"{where}: {key}: expected {kind.__name__}, found {'nothing' if value is None else str(value)[:60]}")
    if kind is str:
        try:
            text(value)
        except ValueError:  # NUL or half a character, which no name in a file can have
            raise Error("format", f"{where}: {key}: expected text, found {ascii(value)[:60]}") from None
    return value


class Run:
    """A run folder. Opening reads run.json alone; images are read when asked for, and nothing stays open.

    folder       str, as given
    json         run.json, as json.load returns it
    passes       list of Pass in the order of the pipeline
    images       dict of Image by name; `run["travelled"]` is images["travelled"]. Those of errors, which `glint replay --against` adds, have the
                 slot "against"
    end_reasons  list of the texts of images in the unit "end reason", whose values are their places in it; empty in runs of an older glint

    Raises Error where the folder is none of a run, or run.json says what cannot be.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = os.fsdecode(folder)
        self.json = self._load(f"{self.folder}/run.json")
        where = f"{self.folder}/run.json"
        if self.json.get("format") != _FORMAT:
            raise Error("unsupported", f"{where}: expected format {_FORMAT}, found {str(self.json.get('format'))[:60]}")
        self.passes = [Pass(self.folder, record) for record in _field(self.json, "passes", list, where)]
        self.images: dict[str, Image] = {}
        compared = _field(self.json, "compared", dict, where) if "compared" in self.json else {"images": []}
        errors = [Image(self.folder, "against", str(compared.get("variant", "")), image) for image in _field(compared, "images", list, where)]
        for image in [image for done in self.passes for image in done.images] + errors:
            self.images.setdefault(image.name, image)
        self.end_reasons = [_field(reason, "text", str, f"{where}: end_reasons") for reason in
                            (_field(self.json, "end_reasons", list, where) if "end_reasons" in self.json else [])]

    @staticmethod
    def _load(path: str) -> dict[str, Any]:
        try:
            with open(path_bytes(path), "rb") as file:
                data = file.read(_JSON_BYTES + 1)
        except OSError as error:
            raise Error("io", f"{path}: {error.strerror}") from error
        if len(data) > _JSON_BYTES:
            raise Error("limit", f"{path}: expected at most {_JSON_BYTES} bytes, found more")
        try:
            found = json.loads(data)
        except (ValueError, RecursionError) as error:
            raise Error("format", f"{path}: {error}") from error
        if not isinstance(found, dict):
            raise Error("format", f"{path}: expected an object, found {type(found).__name__}")
        return found

    def __getitem__(self, name: str) -> Image:
        if name not in self.images:
            raise KeyError(f"{self.folder}: no image {name}; found {', '.join(self.images)}")
        return self.images[name]

    def __repr__(self) -> str:
        return f"<Run {self.folder}: {len(self.passes)} passes, {len(self.images)} images>"
