"""Captures, written from NumPy arrays."""
import ctypes
import os
import threading
import weakref
from collections.abc import Mapping
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glint.capture import Attribute, Path
from glint.convert import scalar, to_struct
from glint.frame import CubeMap, Encodings, Frame, Froxels, Indirect, LightVolume, Planar, Probe, Shadow, Sky, Truth
from glint.library import enum, function, path_bytes, struct, text
from glint.registry import layer

_create = function("glint_writer_create", "path options")
_set_frame = function("glint_writer_set_frame", "writer frame")
_add_part = function("glint_writer_add_part", "writer part")
_finish = function("glint_writer_finish", "writer")
_wait = function("glint_writer_wait", "writer")
_destroy = function("glint_writer_destroy", "writer")
_options = struct("glint_writer_options", "compression threads background")
_part = struct("glint_part", "name width height channels channel_count encodings cubemap planar sky probe indirect shadow volume froxels truth "
               "sibling attributes attribute_count")
_channel = struct("glint_channel", "name type data x_stride_bytes y_stride_bytes storage")
_attribute = struct("glint_attribute", "name type string number")

_COMPRESSIONS = enum("glint_compression")
_KINDS = enum("glint_attribute_type")
_TYPES = {np.dtype(kind): enum("glint_type")[name] for kind, name in (
    ("f2", "f16"), ("f4", "f32"), ("u4", "u32"), ("u1", "unorm8"), ("u2", "unorm16"), ("i1", "snorm8"), ("i2", "snorm16"))}


def _usable(value: ArrayLike, where: str) -> NDArray[Any]:
    """An array whose memory the library can read: native byte order, aligned, positive strides (0 has another meaning there)."""
    array = np.asarray(value)
    kind = array.dtype.newbyteorder("=")
    if kind not in _TYPES:
        raise TypeError(f"{where}: expected an array of {', '.join(map(str, _TYPES))}, found {array.dtype}: convert it, "
                        "floats with .astype(numpy.float32), whole numbers with .astype(numpy.uint32)")
    if not array.dtype.isnative or not array.flags.aligned or any(stride <= 0 for stride in array.strides):
        array = np.ascontiguousarray(array, kind)
    return array


def _planes(name: str, value: ArrayLike, where: str) -> dict[str, NDArray[Any]]:
    """The channels of an entry: one of two dimensions, or several along the last of three."""
    array = _usable(value, where)
    names = name.split()
    if array.ndim == 3:
        if len(names) == 1:
            names = layer(name)[:array.shape[2]]
        if len(names) != array.shape[2] or not names:
            raise ValueError(f"{where}: expected the names of {array.shape[2]} channels or a layer that has them, found {name!r}")
        return {channel: array[:, :, i] for i, channel in enumerate(names)}
    if array.ndim != 2 or len(names) != 1:
        raise ValueError(f"{where}: expected shape (height, width), or (height, width, n) for n channels, found {array.shape}")
    return {name: array}


class Writer:
    """Writes a capture, which appears under its name only when it is complete.

        with glint.Writer("frame.exr", frame) as writer:
            writer.add("gbuffer", {"depth.Z": depth, "normal": normal, "material.roughness": roughness}, glint.Encodings(depth="reversed"))
            writer.add("lit", {"R G B": lit})

    Leaving the `with` statement finishes the file and waits for it; after an exception in the statement no file is left.

    path         str or os.PathLike; a file that is there is replaced
    frame        Frame; None: a file of cube maps only, which captures name as sibling
    compression  "zip", "none", "zips", "piz", "pxr24" (loses 8 bits of float32) or "rle"
    threads      that compress; 0: one for each core
    background   `finish` returns at once, and a thread compresses and writes; `wait` tells how it went

    Raises Error where the library refuses; no pixel is checked: NaN and infinity are written as they are, and `glint.validate` finds them.
    One thread at a time uses a writer, others wait.
    """

    def __init__(self, path: Path, frame: Frame | None, *, compression: str = "zip", threads: int = 0, background: bool = False) -> None:
        self.path = os.fsdecode(path)
        if compression not in _COMPRESSIONS:
            raise ValueError(f"compression: expected one of {', '.join(_COMPRESSIONS)}, found {compression!r}")
        if not 0 <= threads <= 1024:
            raise ValueError(f"threads: expected 0 to 1024, found {threads}")
        described = to_struct(frame) if frame is not None else None
        options = _options(compression=_COMPRESSIONS[compression], threads=threads, background=background)
        self._lock = threading.RLock()
        self._finished = False
        self._handle: Any = _create(path_bytes(path), ctypes.byref(options))
        self._finalizer = weakref.finalize(self, _destroy, ctypes.byref(self._handle))
        if described is not None:
            try:
                _set_frame(self._handle, ctypes.byref(described))
            except BaseException:
                self.close()
                raise

    def _open_handle(self) -> Any:
        if not self._handle:
            raise ValueError(f"{self.path}: the writer is closed")
        return self._handle

    def add(self, name: str, channels: Mapping[str, ArrayLike] | None = None, encodings: Encodings | None = None, *,
            storage: Mapping[str, str] | None = None, cubemap: CubeMap | None = None, planar: Planar | None = None,
            sky: Sky | None = None, probe: Probe | None = None, indirect: Indirect | None = None, shadow: Shadow | None = None,
            volume: LightVolume | None = None, froxels: Froxels | None = None, truth: Truth | None = None,
            sibling: str | None = None, attributes: Mapping[str, Attribute] | None = None) -> None:
        """Adds a part: checks it against its role, and copies the pixels. After an error the writer is as before.

        name        the role, with a number where there may be several: "gbuffer", "cubemap.003", "previous.lit"
        channels    arrays by name: "depth.Z" of shape (height, width); several names "R G B", or a layer "normal", of shape (height, width, n).
                    float16 and float32 are stored as they are; uint32 are whole numbers (stencil.id, packed motion); uint8 and uint16 are
                    fixed point from 0 to 1, int8 and int16 from −1 to 1. Any strides. Other dtypes are a TypeError. Row 0 is the top; cube
                    maps have the shape (6N, N), or (6N, N, n).
        encodings   how the values are encoded; None: canonically, as `Part.read` returns them
        storage     the engine's own format by channel ("D24", "R11G11B10"), which states its precision; default: that of the dtype
        cubemap     required for cubemap.NNN
        planar      required for planar.NNN
        sky         of the part sky; None: without its attributes
        probe       of probe.NNN and its levels; None: without their attributes
        indirect    of the part indirect; None: the engine's own occlusion is not in it
        shadow      required for shadow.NNN
        volume      required for volume.NNN
        froxels     required for froxels
        truth       required for truth.occlusion and truth.sun
        sibling     cubemap.NNN only, without channels: a file in the same folder whose part of this name holds the pixels
        attributes  str, int (32 bits, signed) or float by name, for whoever knows them; names must not begin with "glint."
        """
        planes: dict[str, NDArray[Any]] = {}
        for key, value in (channels or {}).items():
            for channel, plane in _planes(key, value, f"{name}: {key}").items():
                if channel in planes:
                    raise ValueError(f"{name}: {channel}: expected one array, found two")
                planes[channel] = plane
        shapes = {plane.shape for plane in planes.values()}
        if len(shapes) > 1:
            raise ValueError(f"{name}: expected arrays of one size, found " + ", ".join(f"{c} {p.shape}" for c, p in planes.items()))
        unknown = set(storage or ()) - set(planes)
        if unknown:
            raise ValueError(f"{name}: storage: expected channels of the part, found {', '.join(sorted(unknown))}")
        height, width = shapes.pop() if shapes else (0, 0)
        if max(width, height) >= 1 << 32:
            raise ValueError(f"{name}: expected a size of 32 bits, found {width} × {height}")
        part = _part(name=text(name), width=width, height=height, channel_count=len(planes), encodings=to_struct(encodings or Encodings()),
                     sibling=None if sibling is None else text(sibling))
        part.channels = (_channel * len(planes))(*(self._described(c, p, (storage or {}).get(c)) for c, p in planes.items()))
        part.attributes = (_attribute * len(attributes or {}))(*(self._foreign(name, a, v) for a, v in (attributes or {}).items()))
        part.attribute_count = len(attributes or {})
        for member, given in (("cubemap", cubemap), ("planar", planar), ("sky", sky), ("probe", probe), ("indirect", indirect),
                              ("shadow", shadow), ("volume", volume), ("froxels", froxels), ("truth", truth)):
            if given is not None:
                setattr(part, member, ctypes.pointer(to_struct(given)))
        with self._lock:
            _add_part(self._open_handle(), ctypes.byref(part))

    @staticmethod
    def _described(name: str, plane: NDArray[Any], storage: str | None) -> Any:
        return _channel(name=text(name), type=_TYPES[plane.dtype], data=plane.ctypes.data, x_stride_bytes=plane.strides[1],
                        y_stride_bytes=plane.strides[0], storage=None if storage is None else text(storage))

    @staticmethod
    def _foreign(part: str, name: str, value: Attribute) -> Any:
        if isinstance(value, str):
            return _attribute(name=text(name), type=_KINDS["string"], string=text(value))
        if isinstance(value, (int, np.integer)) and not isinstance(value, bool):
            return _attribute(name=text(name), type=_KINDS["int"], number=scalar(value, ctypes.c_int, f"{part}: {name}"))
        return _attribute(name=text(name), type=_KINDS["double"], number=scalar(value, ctypes.c_double, f"{part}: {name}"))

    def finish(self) -> None:
        """Checks the rules between parts and writes the file; in the background, after which the arrays may be changed and `wait` tells
        how it went."""
        with self._lock:
            _finish(self._open_handle())
            self._finished = True

    def wait(self) -> None:
        """Returns when the file is complete, or raises what went wrong in the background."""
        with self._lock:
            _wait(self._open_handle())

    def close(self) -> None:
        """Waits for the thread and frees the memory; without `finish` before it, no file is left. Closing again is no error."""
        with self._lock:
            self._finalizer()

    def __enter__(self) -> "Writer":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        try:
            if error is None:
                if not self._finished:
                    self.finish()
                self.wait()
        finally:
            self.close()
