"""Captures, read: parts as NumPy arrays, decoded as a replay does or as stored."""
import ctypes
import os
import threading
import weakref
from dataclasses import dataclass
from types import TracebackType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import DTypeLike, NDArray

from glint.convert import from_struct
from glint.frame import CubeMap, Encodings, Frame, Froxels, Indirect, LightVolume, Planar, Probe, Shadow, Sky, Truth
from glint.library import Error, callback, constant, enum, function, path_bytes, string, struct, text
from glint.registry import Role, in_order, layer, roles

ARRAY_BYTES = 4 << 30
"""The largest array that a read makes unless `array_bytes` of open says otherwise: a small file may claim any size."""

_open = function("glint_capture_open", "path limits")
_close = function("glint_capture_close", "capture")
_frame = function("glint_capture_frame", "capture")
_part_count = function("glint_capture_part_count", "capture")
_part = function("glint_capture_part", "capture i")
_hash = function("glint_capture_hash", "capture hex")
_read = function("glint_capture_read", "capture part channels count type out threads")
_read_raw = function("glint_capture_read_raw", "capture part channels count type out threads")
_can_read = function("glint_part_can_read", "part channel")
_validate = function("glint_capture_validate", "path limits report user violations")
_report = callback("glint_report")
_notes = function("glint_frame_notes", "frame notes")
_limits = struct("glint_limits", "file_bytes memory_bytes width parts no_link")
struct("glint_channel_info", "name stored storage")
struct("glint_part_info", "name role index level previous width height channels channel_count encodings has_cubemap has_planar has_sky has_probe "
       "has_indirect has_shadow has_volume has_froxels has_truth cubemap planar sky probe indirect shadow volume froxels truth sibling sibling_hash attributes attribute_count")
struct("glint_attribute", "name type string number")

_TYPES = enum("glint_type")
_STORED: dict[int, Any] = {enum("glint_stored")[name]: np.dtype(kind) for name, kind in (("half", "f2"), ("float", "f4"), ("uint", "u4"))}
_STRING, _INT = (enum("glint_attribute_type")[name] for name in ("string", "int"))
_KINDS = {np.dtype("f2"): "f16", np.dtype("f4"): "f32", np.dtype("u1"): "u8", np.dtype("u2"): "u16", np.dtype("u4"): "u32"}

Attribute = str | int | float
Path = str | os.PathLike[str]


@dataclass(frozen=True)
class Channel:
    """A channel as the file has it."""
    name: str
    dtype: np.dtype[Any]
    """float16, float32 or uint32"""
    storage: str
    """the engine's own format, "D24", "R11G11B10", which says how precise it was"""


class Violation(NamedTuple):
    """A rule of FORMAT.md that a file breaks."""
    rule: str
    message: str


def _names(names: list[str]) -> Any:
    return (ctypes.c_char_p * len(names))(*map(text, names))


def faces(image: NDArray[Any]) -> NDArray[Any]:
    """A cube map (6N, N, …) as its six faces (6, N, N, …), +X −X +Y −Y +Z −Z: a view of the same memory."""
    if image.ndim < 2 or image.shape[0] != 6 * image.shape[1]:
        raise ValueError(f"expected an array of shape (6N, N, …), found {image.shape}")
    return image.reshape(6, image.shape[1], *image.shape[1:])


class Part:
    """An image of a capture. Its attributes are copies, and stay when the capture is closed; reading needs it open.

    name           "gbuffer", "cubemap.003", "previous.lit"
    role           Role, or None if this version does not know it; it can be read all the same
    index          the NNN of the name, or −1
    level          the L of a name that ends in .levelL, or 0
    previous       whether the name begins with "previous."
    width, height  pixels; of a part with a sibling, those of the sibling's part
    channels       dict of Channel by name, R G B A and X Y Z in this order
    encodings      Encodings that the engine declared
    cubemap        CubeMap of a part cubemap.NNN, else None
    planar         Planar of a part planar.NNN, else None
    sky            Sky of the part sky, else None
    probe          Probe of a part probe.NNN or one of its levels, else None
    indirect       Indirect of the part indirect, else None
    shadow         Shadow of a part shadow.NNN, else None
    volume         LightVolume of a part volume.NNN, else None
    froxels        Froxels of the part froxels, else None
    truth          Truth of the parts truth.occlusion and truth.sun, else None
    sibling        name of the file in the same folder that holds the pixels; "": none
    sibling_hash   its XXH3-128, which was verified; "": no sibling
    attributes     dict of str, int or float: attributes that glint does not know
    """

    def __init__(self, capture: "Capture", pointer: Any) -> None:
        info = pointer.contents
        self._capture = capture
        self._pointer = pointer
        self.name = string(info.name)
        self.role: Role | None = roles()[string(info.role.contents.name)] if info.role else None
        self.index: int = info.index
        self.level: int = info.level
        self.previous: bool = info.previous
        self.width: int = info.width
        self.height: int = info.height
        found = {string(c.name): Channel(string(c.name), _STORED[c.stored.value], string(c.storage)) for c in info.channels[:info.channel_count]}
        order = [name for name in (self.role.channels if self.role else ()) if name in found]
        self.channels = {name: found[name] for name in order + in_order([name for name in found if name not in order])}
        self.encodings: Encodings = from_struct(info.encodings)
        self.cubemap: CubeMap | None = from_struct(info.cubemap) if info.has_cubemap else None
        self.planar: Planar | None = from_struct(info.planar) if info.has_planar else None
        self.sky: Sky | None = from_struct(info.sky) if info.has_sky else None
        self.probe: Probe | None = from_struct(info.probe) if info.has_probe else None
        self.indirect: Indirect | None = from_struct(info.indirect) if info.has_indirect else None
        self.shadow: Shadow | None = from_struct(info.shadow) if info.has_shadow else None
        self.froxels: Froxels | None = from_struct(info.froxels) if info.has_froxels else None
        self.volume: LightVolume | None = from_struct(info.volume) if info.has_volume else None
        self.truth: Truth | None = from_struct(info.truth) if info.has_truth else None
        self.sibling = string(info.sibling)
        self.sibling_hash = string(info.sibling_hash)
        self.attributes: dict[str, Attribute] = {}
        for a in info.attributes[:info.attribute_count]:
            kind = a.type.value
            self.attributes[string(a.name)] = string(a.string) if kind == _STRING else int(a.number) if kind == _INT else a.number

    def __repr__(self) -> str:
        return f"<Part {self.name}: {self.width} × {self.height}, {', '.join(self.channels)}>"

    def can_read(self, channel: str) -> bool:
        """Whether `read` knows the channel: it is stored, follows from others (the Z of a normal), or has a value for parts without it."""
        if channel in self.channels:
            return True
        row = self.role.channels.get(channel) if self.role else None
        return row is not None and (row.absent is not None or self._rebuilt(channel))

    def _rebuilt(self, channel: str) -> bool:
        with self._capture._lock:
            return bool(_can_read(self._capture._part_pointer(self), text(channel)))

    def _resolve(self, names: tuple[str, ...], stored: bool) -> tuple[list[str], bool]:
        """The channels that these names, each of a channel or of a layer, stand for; whether it is one that was named itself."""
        if not names:
            return list(self.channels), False
        found: list[str] = []
        for name in names:
            if not isinstance(name, str):
                raise TypeError(f"{self.name}: expected names of channels, found {type(name).__name__}")
            of_layer = [c for c in self.channels if c.startswith(name + ".")]
            if not stored and self.role:
                of_layer = [c for c in layer(name) if c in self.role.channels and self.can_read(c)] or of_layer
            found += [name] if name in self.channels or not of_layer else of_layer
        return found, len(names) == 1 and found == list(names)

    def _array(self, channels: list[str], dtype: np.dtype[Any]) -> NDArray[Any]:
        size = self.width * self.height * len(channels) * dtype.itemsize
        if size > self._capture.array_bytes:
            raise Error("limit", f"{self._capture.path}: part {self.name}: expected at most {self._capture.array_bytes} bytes, found {self.width} × "
                        f"{self.height} pixels of {len(channels)} channels, {size} bytes: open it with array_bytes={size} if this is meant")
        return np.empty((self.height, self.width, len(channels)), dtype)

    def _fill(self, call: Any, channels: list[str], dtype: np.dtype[Any], threads: int) -> NDArray[Any]:
        if not 0 <= threads <= 1024:
            raise ValueError(f"threads: expected 0 to 1024, found {threads}")
        out = self._array(channels, dtype)
        with self._capture._lock:
            call(self._capture._open_handle(), self._pointer, _names(channels), len(channels), _TYPES[_KINDS[dtype]],
                 out.ctypes.data_as(ctypes.c_void_p), threads)
        return out

    def read(self, *channels: str, dtype: DTypeLike = None, threads: int = 0) -> NDArray[Any]:
        """Pixels decoded to canonical values, as a replay sees them, whatever the engine's encodings.

        Names are of channels ("depth.Z") or of layers ("normal": normal.X, normal.Y, normal.Z); none: all that the part stores. One channel
        gives an array of shape (height, width), anything else one of shape (height, width, n). Row 0 is the top of the picture, or of a cube
        map's face +X. The array is new and belongs to the caller.

        Values are view depth in metres (+inf: sky), unit normals in world space, perceptual roughness in [0, 1], motion in uv (Z in metres),
        linear radiance, distances in metres. A channel that the part does not have is read as the value that its role states for this
        case (`role.channels[name].absent`). Pixels are not checked: `validate` does that.

        dtype is float32 (default) or float16; for channels of whole numbers such as stencil.id, which need a call of their own, uint32
        (default), uint16 or uint8, where a value that does not fit is an error. threads 0: all cores. Raises Error.
        """
        names, one = self._resolve(channels, stored=False)
        kind = np.dtype(dtype) if dtype is not None else self._decoded(names)
        if kind not in _KINDS:
            raise TypeError(f"{self.name}: expected a dtype of {', '.join(map(str, _KINDS))}, found {kind}")
        array = self._fill(_read, names, kind, threads)
        return array[:, :, 0] if one else array

    def _decoded(self, names: list[str]) -> np.dtype[Any]:
        """float32, unless all are whole numbers that no encoding makes anything else of."""
        def whole(name: str) -> bool:
            row = self.role.channels.get(name) if self.role else None
            return name in self.channels and self.channels[name].dtype.kind == "u" and not (row and row.encoding)
        return np.dtype("u4" if names and all(map(whole, names)) else "f4")

    def read_raw(self, *channels: str, threads: int = 0) -> NDArray[Any]:
        """Pixels as stored, without decoding, in the dtype that the file has them in: float16, float32 or uint32 (half and float together:
        float32). Only channels that are stored can be named. Shapes and errors are those of `read`."""
        names, one = self._resolve(channels, stored=True)
        kinds = {self.channels[name].dtype for name in names if name in self.channels}
        array = self._fill(_read_raw, names, np.dtype("u4" if kinds == {np.dtype("u4")} else "f4"), threads)
        if kinds == {np.dtype("f2")}:
            array = array.astype("f2")
        return array[:, :, 0] if one else array


class Capture:
    """An open capture. Use it in a `with` statement, or call `close`; it is closed at the latest when nothing refers to it any more.

    path   str, as given
    frame  Frame: the cameras and other attributes of the frame. Changing it changes no file.
    parts  dict of Part by name, in the file's order; `capture["gbuffer"]` is parts["gbuffer"]

    All are copies and stay when it is closed. Several threads may use one capture, one read at a time.
    """

    def __init__(self, path: Path, limits: Any, array_bytes: int) -> None:
        self.path = os.fsdecode(path)
        self.array_bytes = array_bytes
        self._lock = threading.RLock()
        self._handle: Any = _open(path_bytes(path), ctypes.byref(limits))
        self._finalizer = weakref.finalize(self, _close, ctypes.byref(self._handle))
        try:
            self.frame: Frame = from_struct(_frame(self._handle).contents)
            self.parts = {part.name: part for part in (Part(self, _part(self._handle, i)) for i in range(_part_count(self._handle)))}
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> "Capture":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def __getitem__(self, name: str) -> Part:
        if name not in self.parts:
            raise KeyError(f"{self.path}: no part {name}; found {', '.join(self.parts)}")
        return self.parts[name]

    def __repr__(self) -> str:
        return f"<Capture {self.path}: {', '.join(self.parts)}>"

    def _open_handle(self) -> Any:
        if not self._handle:
            raise ValueError(f"{self.path}: the capture is closed")
        return self._handle

    def _part_pointer(self, part: Part) -> Any:
        self._open_handle()
        return part._pointer

    def close(self) -> None:
        """Releases the file. Reading from its parts is an error afterwards; closing again is none."""
        with self._lock:
            self._finalizer()

    def hash(self) -> str:
        """The XXH3-128 of the file's bytes, 32 hexadecimal digits: what run.json names the capture by. Reads the whole file."""
        digits = ctypes.create_string_buffer(33)
        with self._lock:
            _hash(self._open_handle(), digits)
        return digits.value.decode()

    def notes(self) -> list[str]:
        """Warnings about a valid frame, such as a camera that is too imprecise for its distance from the origin."""
        found = ((ctypes.c_char * constant("GLINT_NOTE_LENGTH")) * constant("GLINT_NOTES"))()
        with self._lock:
            count = _notes(_frame(self._open_handle()), found)
        return [string(found[i].value) for i in range(count)]


def _limits_of(file_bytes: int, memory_bytes: int, width: int, parts: int) -> Any:
    for name, value, bits in (("file_bytes", file_bytes, 64), ("memory_bytes", memory_bytes, 64), ("width", width, 32), ("parts", parts, 32)):
        if not 0 <= value < 1 << bits:
            raise ValueError(f"{name}: expected 0 to 2^{bits} - 1, found {value}")
    return _limits(file_bytes=file_bytes, memory_bytes=memory_bytes, width=width, parts=parts)


def open(path: Path, *, file_bytes: int = 0, memory_bytes: int = 0, width: int = 0, parts: int = 0, array_bytes: int = ARRAY_BYTES) -> Capture:
    """Opens a capture: reads headers and attributes and checks them against FORMAT.md; no pixel is read.

    Limits protect from files that claim too much, 0 being the library's default: `file_bytes` (64 GiB), `memory_bytes` of the library's own
    memory at a time (4 GiB), `width` of any part (32768 pixels; heights: six times that), number of `parts` (1024), and `array_bytes`
    of one array that a read returns (4 GiB). Raises Error.
    """
    return Capture(path, _limits_of(file_bytes, memory_bytes, width, parts), array_bytes)


def validate(path: Path) -> list[Violation]:
    """Checks every rule of FORMAT.md, pixels included: what a file breaks, one Violation for each rule and channel; an empty list: it is valid.
    Raises Error when the file cannot be read at all."""
    found: list[Violation] = []
    def report(user: Any, rule: bytes, message: bytes) -> None:
        found.append(Violation(string(rule), string(message)))
    count = ctypes.c_size_t()
    _validate(path_bytes(path), None, _report(report), None, ctypes.byref(count))
    return found
