"""C declarations as ctypes: structs, enums and function prototypes, parsed from the text that libglint-capture carries. Their layout is
written once, in the library's headers, and is always that of the library which is loaded."""
import ctypes
import os
import re
from typing import Any, NamedTuple

_SCALARS: dict[str, Any] = {
    "void": None, "_Bool": ctypes.c_bool, "char": ctypes.c_char, "int": ctypes.c_int, "float": ctypes.c_float, "double": ctypes.c_double,
    "size_t": ctypes.c_size_t, "int32_t": ctypes.c_int32, "uint8_t": ctypes.c_uint8, "uint16_t": ctypes.c_uint16,
    "uint32_t": ctypes.c_uint32, "uint64_t": ctypes.c_uint64}
_TOKEN = re.compile(r"\s*(\.\.\.|\w+|[{}()\[\];,*=-])")


class Unknown(Exception):
    """The text holds C that this parser does not know."""


class Function(NamedTuple):
    """A prototype in ctypes."""
    result: Any
    parameters: dict[str, Any]  # by name, in order


class Declarations:
    """What a text declares.

    structs:   name to ctypes.Structure. One without a body in the text has no fields: it is only pointed to.
    enums:     name to a subclass of ctypes.c_int, whose `values` are the constants in lower case without what all their names begin with
    functions: name to Function. Functions of variable length, such as printf, are left out.
    callbacks: name of a function pointer's type to its ctypes.CFUNCTYPE
    constants: name to value, of all enums
    """

    def __init__(self, text: str) -> None:
        self.structs: dict[str, Any] = {}
        self.enums: dict[str, Any] = {}
        self.functions: dict[str, Function] = {}
        self.callbacks: dict[str, Any] = {}
        self.constants: dict[str, int] = {}
        self._tokens = self._split(text)
        self._at = 0
        while self._peek():
            self._declaration()

    @staticmethod
    def _split(text: str) -> list[str]:
        tokens: list[str] = []
        at, end = 0, len(text.rstrip())
        while at < end:
            match = _TOKEN.match(text, at)
            if not match:
                raise Unknown(f"expected C, found {text[at:at + 40]!r}")
            tokens.append(match[1])
            at = match.end()
        return tokens

    def _peek(self, ahead: int = 0) -> str:
        at = self._at + ahead
        return self._tokens[at] if at < len(self._tokens) else ""

    def _take(self, expected: str = "") -> str:
        token = self._peek()
        if not token or (expected and token != expected):
            raise Unknown(f"expected {expected or 'more'} at the end of: {' '.join(self._tokens[max(self._at - 8, 0):self._at + 1])}")
        self._at += 1
        return token

    def _took(self, token: str) -> bool:
        """Whether the next token is this one, which is then taken."""
        if self._peek() != token:
            return False
        self._at += 1
        return True

    def _declaration(self) -> None:
        self._skip_attributes()
        if self._took("typedef"):
            self._callback()
        elif self._peek() == "enum" and "{" in (self._peek(1), self._peek(2)):
            self._enum()
        elif self._peek() == "struct" and self._peek(2) in ("{", ";"):
            self._struct()
        else:
            self._function()

    def _skip_attributes(self) -> None:
        while self._peek() in ("extern", "__attribute__", "__declspec"):
            if self._take() == "extern":
                continue
            depth = 0
            while True:
                depth += {"(": 1, ")": -1}.get(self._take(), 0)
                if depth == 0:
                    break

    def _number(self) -> int:
        sign = -1 if self._took("-") else 1
        token = self._take()
        if token in self.constants:
            return sign * self.constants[token]
        if not token.isdigit():
            raise Unknown(f"expected a number, found {token}")
        return sign * int(token)

    def _enum(self) -> None:
        self._take("enum")
        name = "" if self._peek() == "{" else self._take()
        self._take("{")
        constants: dict[str, int] = {}
        value = 0
        while not self._took("}"):
            constant = self._take()
            if self._took("="):
                value = self._number()
            constants[constant] = value
            value += 1
            self._took(",")
        self._take(";")
        self.constants.update(constants)
        shared = os.path.commonprefix(list(constants)).rpartition("_")[0] + "_"
        self.enums[name] = type(name or "anonymous", (ctypes.c_int,),
                                {"values": {c.removeprefix(shared).lower(): v for c, v in constants.items()}})

    def _struct_named(self, name: str) -> Any:
        if name not in self.structs:
            self.structs[name] = type(name, (ctypes.Structure,), {})
        return self.structs[name]

    def _struct(self) -> None:
        self._take("struct")
        made = self._struct_named(self._take())
        if self._took("{"):
            fields: list[tuple[str, Any]] = []
            while not self._took("}"):
                base, constant = self._base()
                fields.append(self._declarator(base, constant))
                while self._took(","):
                    fields.append(self._declarator(base, constant))
                self._take(";")
            made._fields_ = fields
        self._take(";")

    def _base(self) -> tuple[Any, bool]:
        """A type without its pointers and arrays, and whether it is const."""
        constant = self._took("const")
        token = self._take()
        if token == "struct":
            return self._struct_named(self._take()), constant
        known = self.enums if token == "enum" else _SCALARS | self.callbacks
        name = self._take() if token == "enum" else token
        if name not in known:
            raise Unknown(f"expected a type, found {name}")
        return known[name], constant

    def _declarator(self, kind: Any, constant: bool, parameter: bool = False) -> tuple[str, Any]:
        """The name and the type with its pointers and arrays."""
        while self._peek() in ("*", "const"):
            if self._take() == "const":
                continue
            if kind is ctypes.c_char and constant:
                kind = ctypes.c_char_p
            else:
                kind = ctypes.c_void_p if kind is None else ctypes.POINTER(kind)
        name = "" if self._peek() in (")", ",") else self._take()
        lengths: list[int] = []
        while self._took("["):
            lengths.append(self._number())
            self._take("]")
        for length in reversed(lengths[1:] if parameter else lengths):
            kind = kind * length
        return name, ctypes.POINTER(kind) if parameter and lengths else kind  # an array as a parameter is a pointer

    def _parameters(self) -> dict[str, Any] | None:
        """None for those of a function of variable length."""
        kinds: dict[str, Any] = {}
        variable = False
        self._take("(")
        while not self._took(")"):
            if self._took("..."):
                variable = True
            else:
                name, kind = self._declarator(*self._base(), parameter=True)
                if kind is not None:  # (void)
                    kinds[name] = kind
            self._took(",")
        return None if variable else kinds

    def _function(self) -> None:
        name, result = self._declarator(*self._base())
        parameters = self._parameters()
        self._skip_attributes()
        self._take(";")
        if parameters is not None:
            self.functions[name] = Function(result, parameters)

    def _callback(self) -> None:
        result, _ = self._base()
        self._take("(")
        self._take("*")
        name = self._take()
        self._take(")")
        parameters = self._parameters()
        self._take(";")
        self.callbacks[name] = ctypes.CFUNCTYPE(result, *(parameters or {}).values())
