"""The library's structs as dataclasses, and back. A dataclass has the fields of its struct under the same names: `has_X` beside `X` becomes
X | None, and a count beside an array the array's length, where the field's metadata name it. What differs is found when the package is
loaded."""
import ctypes
import dataclasses
from typing import Any, Callable, TypeVar

import numpy as np

from glint.library import mismatch, string, struct, text

_T = TypeVar("_T")
_classes: dict[str, Any] = {}  # by the name of the struct
_SIGNS = {"neg_x": "-x", "neg_y": "-y", "neg_z": "-z", "x": "+x", "y": "+y", "z": "+z"}  # axes, as FORMAT.md spells them


def counted(count: str, default: Any) -> Any:
    """A field of several elements, whose number is in another member of the struct."""
    return dataclasses.field(default_factory=default, metadata={"count": count})


def mirrors(name: str) -> Callable[[type[_T]], type[_T]]:
    """Decorates the dataclass of a struct, after checking that it has all its fields and no others."""
    def checked(cls: type[_T]) -> type[_T]:
        kind = struct(name, "")
        theirs = {field for field, _ in kind._fields_}
        ours = {field.name for field in dataclasses.fields(cls)}
        ours |= {field.metadata["count"] for field in dataclasses.fields(cls) if "count" in field.metadata}
        ours |= {f"has_{field}" for field in ours} & theirs
        if ours != theirs:
            raise mismatch(f"its struct {name} differs from {cls.__name__} in {', '.join(sorted(ours ^ theirs))}")
        _classes[name] = cls
        setattr(cls, "_struct", kind)
        return cls
    return checked


def enum_name(kind: Any, value: int) -> str:
    name = next((n for n, v in kind.values.items() if v == value), str(value))
    return _SIGNS.get(name, name)


def enum_value(kind: Any, name: Any, where: str) -> int:
    names = {_SIGNS.get(n, n): v for n, v in kind.values.items()}
    if name not in names:
        raise ValueError(f"{where}: expected one of {', '.join(names)}, found {name!r}")
    value: int = names[name]
    return value


# ---- from the library ----

def from_struct(value: Any) -> Any:
    """The dataclass of a struct, copied."""
    cls = _classes[type(value).__name__]
    there = {name for name, _ in value._fields_}
    found: dict[str, Any] = {}
    for field in dataclasses.fields(cls):
        if f"has_{field.name}" in there and not getattr(value, f"has_{field.name}"):
            found[field.name] = None
            continue
        element = getattr(value, field.name)
        count = getattr(value, field.metadata["count"]) if "count" in field.metadata else None
        found[field.name] = _from(element, count)
    return cls(**found)


def _from(value: Any, count: int | None) -> Any:
    if isinstance(value, ctypes.Structure):
        return from_struct(value)
    if isinstance(value, bytes):
        return string(value)
    if isinstance(value, ctypes.c_int):
        return enum_name(type(value), value.value)
    if not isinstance(value, ctypes.Array):
        return value
    if issubclass(value._type_, ctypes.Structure):
        return [from_struct(element) for element in value[:count]]
    array = np.array(value, np.float64)[:count]
    return array.reshape(4, 4) if array.shape == (16,) else array


# ---- to the library ----

def to_struct(value: Any) -> Any:
    """The struct of a dataclass, copied. TypeError or ValueError names the field that does not fit."""
    out = value._struct()
    _fill(value, out)
    return out


def _fill(value: Any, out: Any) -> None:
    kinds = dict(out._fields_)
    for field in dataclasses.fields(value):
        element, where = getattr(value, field.name), f"{type(value).__name__}.{field.name}"
        if f"has_{field.name}" in kinds:
            setattr(out, f"has_{field.name}", element is not None)
            if element is None:
                continue
        if "count" in field.metadata:
            _fill_counted(element, kinds[field.name], getattr(out, field.name), where)
            setattr(out, field.metadata["count"], len(element))
        elif issubclass(kinds[field.name], ctypes.Structure):
            if not isinstance(element, _classes[kinds[field.name].__name__]):
                raise TypeError(f"{where}: expected {_classes[kinds[field.name].__name__].__name__}, found {type(element).__name__}")
            _fill(element, getattr(out, field.name))
        elif issubclass(kinds[field.name], ctypes.Array):
            _fill_array(element, kinds[field.name], getattr(out, field.name), out, field.name, where)
        else:
            setattr(out, field.name, scalar(element, kinds[field.name], where))


def _fill_counted(elements: Any, kind: Any, out: Any, where: str) -> None:
    if len(elements) > kind._length_:
        raise ValueError(f"{where}: expected at most {kind._length_}, found {len(elements)}")
    if issubclass(kind._type_, ctypes.Structure):
        for i, element in enumerate(elements):
            _fill(element, out[i])
    else:
        numbers = np.frombuffer(out, np.float64).reshape(np.shape(out))
        numbers[:len(elements)] = _numbers(elements, (len(elements), *numbers.shape[1:]), where)


def _fill_array(value: Any, kind: Any, out: Any, owner: Any, name: str, where: str) -> None:
    if kind._type_ is ctypes.c_char:
        encoded = text(value)
        if len(encoded) >= kind._length_:
            raise ValueError(f"{where}: expected at most {kind._length_ - 1} bytes, found {len(encoded)}")
        setattr(owner, name, encoded)
    else:
        shape = (4, 4) if kind._length_ == 16 else (kind._length_,)
        out[:] = _numbers(value, shape, where).ravel().tolist()


def _numbers(value: Any, shape: tuple[int, ...], where: str) -> Any:
    array = np.asarray(value)
    if array.size and array.dtype.kind not in "iuf":
        raise TypeError(f"{where}: expected numbers, found {array.dtype}")
    if array.shape != shape and (array.size or 0 not in shape):
        raise ValueError(f"{where}: expected shape {shape}, found {array.shape}")
    return array.astype(np.float64).reshape(shape)


def scalar(value: Any, kind: Any, where: str) -> Any:
    """A value that the ctypes type holds as it is: ctypes itself would cut integers off."""
    if issubclass(kind, ctypes.c_int) and kind is not ctypes.c_int:
        return enum_value(kind, value, where)
    if kind is ctypes.c_bool:
        if not isinstance(value, (bool, np.bool_)):
            raise TypeError(f"{where}: expected a bool, found {type(value).__name__}")
        return bool(value)
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, float, np.integer, np.floating)):
        raise TypeError(f"{where}: expected a number, found {type(value).__name__}")
    if kind in (ctypes.c_float, ctypes.c_double):
        return float(value)
    if not isinstance(value, (int, np.integer)):
        raise TypeError(f"{where}: expected an integer, found {type(value).__name__}")
    if kind(int(value)).value != int(value):
        raise ValueError(f"{where}: expected an integer of {8 * ctypes.sizeof(kind)} bits, {'' if kind(-1).value < 0 else 'un'}signed, found {value}")
    return int(value)
