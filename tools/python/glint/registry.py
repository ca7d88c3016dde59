"""Roles and channels of the capture format, from the library's registry."""
import ctypes
import functools
import math
from dataclasses import dataclass

from glint.library import enum, function, string, struct

_roles = function("glint_roles", "count")
_SHAPES = {value: name for name, value in enum("glint_shape").items()}
struct("glint_role", "name shape required numbered may_be_previous reserved channels channel_count meaning")
struct("glint_role_channel", "name required unit encoding meaning absent")


@dataclass(frozen=True)
class RoleChannel:
    """A channel that parts of a role may have."""
    name: str
    required: bool
    unit: str
    """of decoded values: "m", "uv", "radiance", "1", "relative\""""
    encoding: str
    """the field of Encodings that applies; "": none"""
    meaning: str
    absent: float | None
    """what a part without the channel is read as; None: it cannot be read then"""


@dataclass(frozen=True)
class Role:
    """What a part may be. Its name with a '.' at the end may be followed by any text, a numbered one by '.' and three digits."""
    name: str
    shape: str
    """"frame" (the size of gbuffer), "cube" (N × 6N), "levels" (the same, with coarser levels in parts NAME.level1 …) or "any\""""
    required: bool
    numbered: bool
    may_be_previous: bool
    reserved: bool
    channels: dict[str, RoleChannel]
    """empty: any"""
    meaning: str


@functools.cache
def roles() -> dict[str, Role]:
    """All roles by name, in the order of FORMAT.md."""
    count = ctypes.c_size_t()
    rows = _roles(ctypes.byref(count))
    found = {}
    for row in rows[:count.value]:
        channels = {string(c.name): RoleChannel(string(c.name), c.required, string(c.unit), string(c.encoding), string(c.meaning),
                                                None if math.isnan(c.absent) else c.absent)
                    for c in row.channels[:row.channel_count]}
        found[string(row.name)] = Role(string(row.name), _SHAPES[row.shape.value], row.required, row.numbered, row.may_be_previous,
                                       row.reserved, channels, string(row.meaning))
    return found


@functools.cache
def _order() -> dict[str, int]:
    """The place of a channel's last letters within its layer: of R G B A, X Y Z and the names of the registry."""
    names = [name.rpartition(".")[2] for role in roles().values() for name in role.channels]
    return {name: i for i, name in enumerate(dict.fromkeys(["R", "G", "B", "A", *names]))}


def in_order(channels: list[str]) -> list[str]:
    """Channels of a layer as R G B A and X Y Z; the file has them by the alphabet."""
    order = _order()
    return sorted(channels, key=lambda name: (name.rpartition(".")[0], order.get(name.rpartition(".")[2], len(order)), name))


def layer(name: str) -> list[str]:
    """The channels that the registry has in a layer, "normal": normal.X, normal.Y, normal.Z; empty if it has none."""
    return list(dict.fromkeys(c for role in roles().values() for c in role.channels if c.startswith(name + ".")))
