"""libglint-capture: found, loaded, and checked against what this package uses of it."""
import ctypes
import glob
import os
from typing import Any, Callable

from glint.declarations import Declarations, Unknown

NAME = "libglint-capture.so"


class Error(Exception):
    """What the library or a file's contents refuse.

    str() is one line that names the file, the part, what was expected and what was found. `code` says whose fault it is:
    "usage" (the call), "io" (the operating system), "format" (the file breaks a rule of FORMAT.md), "limit" (within the format, but
    past a limit of this reader), "unsupported", "memory".
    """

    def __init__(self, code: str, message: str) -> None:
        super().__init__(message)
        self.code = code


def _places() -> list[str]:
    """Where the library may be: where GLINT_LIBRARY says; beside an installed package, which is in PREFIX/share/glint/python; in the build
    folders of a clone; or where the loader looks."""
    if os.environ.get("GLINT_LIBRARY"):
        return [os.environ["GLINT_LIBRARY"]]
    above = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    if os.path.basename(above) == "glint":
        prefix = os.path.dirname(os.path.dirname(above))
        found = [path for folder in ("lib", "lib/*-linux-gnu", "lib64") for path in glob.glob(os.path.join(prefix, folder, NAME))]
    else:
        found = [os.path.join(os.path.dirname(above), build, "capture-format", NAME) for build in ("build", "build-release")]
    return [path for path in found if os.path.exists(path)] + [NAME]


def _load() -> tuple[Any, str]:
    problems = []
    for path in _places():
        try:
            return ctypes.CDLL(path), path
        except OSError as error:
            problems.append(str(error))
    raise ImportError("glint: cannot load libglint-capture: " + "; ".join(problems) + ". Install it (./dev install), build it, or set GLINT_LIBRARY to its path")


_loaded, PATH = _load()


def mismatch(what: str) -> ImportError:
    return ImportError(f"glint: {PATH} does not fit this package: {what}. Install both from one version, or set GLINT_LIBRARY to the library that came with it")


def _declare() -> Declarations:
    try:
        text = _loaded.glint_declarations
    except AttributeError:
        raise mismatch("it does not carry its declarations (glint_declarations)") from None
    text.restype = ctypes.c_char_p
    try:
        return Declarations(text().decode())
    except Unknown as error:
        raise mismatch(f"its declarations: {error}") from None


_declared = _declare()


def struct(name: str, fields: str) -> Any:
    """The struct of this name as a ctypes.Structure. `fields` are those that the caller uses, separated by spaces."""
    found = _declared.structs.get(name)
    if found is None:
        raise mismatch(f"it has no struct {name}")
    there = [field for field, _ in getattr(found, "_fields_", [])]
    for field in fields.split():
        if field not in there:
            raise mismatch(f"its struct {name} has no {field}; found {', '.join(there)}")
    return found


class _Constants(dict[str, int]):
    def __missing__(self, name: str) -> int:
        raise mismatch(f"an enum has no {name}; found {', '.join(self)}")


def enum(name: str) -> dict[str, int]:
    """The constants of an enum by name: of enum glint_compression {"zip": 0, "none": 1, …}."""
    if name not in _declared.enums:
        raise mismatch(f"it has no enum {name}")
    return _Constants(_declared.enums[name].values)


def constant(name: str) -> int:
    """The value of an enum's constant, by its full name."""
    if name not in _declared.constants:
        raise mismatch(f"it has no constant {name}")
    return _declared.constants[name]


def callback(name: str) -> Any:
    """The ctypes type of a function pointer, which makes a Python function one."""
    if name not in _declared.callbacks:
        raise mismatch(f"it has no function type {name}")
    return _declared.callbacks[name]


_CODES = {value: name.removeprefix("error_") for name, value in enum("glint_code").items()}
_error = struct("glint_error", "code message")


def function(name: str, parameters: str) -> Callable[..., Any]:
    """The library's function, which must have exactly these parameters. A last parameter `err` is filled in here: what the function reports
    is raised as Error. The lock on Python is released during the call."""
    found = _declared.functions.get(name)
    if found is None or not hasattr(_loaded, name):
        raise mismatch(f"it has no function {name}")
    declared = list(found.parameters)
    reports = declared[-1:] == ["err"]
    if declared[:-1 if reports else None] != parameters.split():
        raise mismatch(f"{name} takes ({', '.join(declared)}), expected ({', '.join(parameters.split())})")
    call = getattr(_loaded, name)
    call.restype = found.result
    call.argtypes = list(found.parameters.values())
    if not reports:
        return call  # type: ignore[no-any-return]

    def checked(*arguments: Any) -> Any:
        error = _error()
        result = call(*arguments, ctypes.byref(error))
        if not result:
            raise Error(_CODES.get(error.code.value, "unknown"), error.message.decode(errors="backslashreplace"))
        return result
    return checked


def text(value: str) -> bytes:
    """A string for the library, in UTF-8; names that were read from a file keep bytes that are none."""
    if not isinstance(value, str):
        raise TypeError(f"expected a string, found {type(value).__name__}")
    if "\0" in value:
        raise ValueError(f"{value!r}: expected a string without NUL")
    return value.encode(errors="surrogateescape")


def string(value: bytes | None) -> str:
    """A string of the library's; bytes that are no UTF-8 are kept as surrogates."""
    return (value or b"").decode(errors="surrogateescape")


def path_bytes(path: str | os.PathLike[str]) -> bytes:
    """A path for the library."""
    name = os.fsencode(path)
    if b"\0" in name:
        raise ValueError(f"{path!r}: expected a path without NUL")
    return name
