"""The expressions of a mapping: arithmetic over images, matrices and constants, as NumPy arrays.

An expression is Python's syntax and nothing of Python's power: ast parses it, and only what this file lists is computed. No attribute
of an object is reachable, no import, no name that the mapping does not define, no loop.

Images are (height, width, components), row 0 at the top of the picture, and cube maps (6, size, size, components), in double precision.
A value of three dimensions or four is an image, of two a matrix, of one a vector; a number broadcasts over all of them. An image of one
component broadcasts over images of several.
"""
import ast
import difflib
import warnings

import numpy as np

LETTERS = {letter: index for group in ("rgba", "xyzw") for index, letter in enumerate(group)}
DEEPEST = 100


class ExpressionError(Exception):
    """What is wrong with an expression; the caller adds the mapping's key."""


def _last(operation):
    return lambda a: operation(a, axis=-1, keepdims=True)


def _stack(*parts):
    parts = [np.asarray(p, float) for p in parts]
    if all(p.ndim == 0 for p in parts):
        return np.array(parts)
    shape = max((p.shape[:-1] for p in parts), key=len)
    return np.concatenate([np.broadcast_to(p, shape + (p.shape[-1] if p.ndim else 1,)) for p in parts], axis=-1)


def _dot(a, b):
    return np.sum(a * b, axis=-1, keepdims=True)


def _normalize(a):
    length = np.sqrt(_dot(a, a))
    return np.divide(a, length, out=np.zeros_like(a), where=length > 0)


def _smooth(low, high, a):
    t = np.clip((a - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


def _decode_srgb(a):
    a = np.asarray(a, float)
    return np.where(a <= 0.04045, a / 12.92, ((np.maximum(a, 0) + 0.055) / 1.055) ** 2.4)


def _transform(matrix, a):
    """The matrix, for column vectors, times each pixel's vector; a 4x4 matrix times three components is that of directions."""
    size = a.shape[-1]
    if matrix.ndim != 2 or min(matrix.shape) < size:
        raise ExpressionError(f"transform takes a matrix of at least {size} x {size}, found {describe(matrix)}")
    return a @ matrix[:size, :size].T


def _resize(a, like):
    """Bilinear, as a sampler with clamped edges reads the image at the centres of the other image's pixels."""
    if a.ndim != 3 or like.ndim != 3:
        raise ExpressionError(f"resize takes two images, found {describe(a)} and {describe(like)}")
    for axis in (0, 1):
        at = (np.arange(like.shape[axis]) + 0.5) * a.shape[axis] / like.shape[axis] - 0.5
        low = np.floor(at).astype(int)
        part = (at - low).reshape((-1, 1, 1) if axis == 0 else (1, -1, 1))
        last = a.shape[axis] - 1
        a = np.take(a, np.clip(low, 0, last), axis) * (1 - part) + np.take(a, np.clip(low + 1, 0, last), axis) * part
    return a


def _step(a, axis):
    """The difference to the next pixel along an axis, or from the last one, whichever is smaller: so it stays on one surface."""
    if a.ndim != 3 or a.shape[axis] < 2:
        raise ExpressionError(f"dx and dy take an image of at least two pixels each way, found {describe(a)}")
    step = np.diff(a, axis=axis)
    first, last = np.take(step, [0], axis), np.take(step, [-1], axis)
    ahead, behind = np.concatenate([step, last], axis), np.concatenate([first, step], axis)
    return np.where(_dot(ahead, ahead) <= _dot(behind, behind), ahead, behind)


def _matrix(*numbers):
    size = {9: 3, 16: 4}.get(len(numbers))
    if size is None or any(n.ndim for n in numbers):
        raise ExpressionError("matrix takes 9 or 16 numbers, row by row")
    return np.array(numbers, float).reshape(size, size)


def _grid(like):
    """(u, v) of the pixels' centres; (0, 0) is the upper left corner of the picture."""
    v, u = [(np.arange(n) + 0.5) / n for n in like.shape[:2]]
    return np.stack(np.broadcast_arrays(u[None, :], v[:, None]), axis=-1)


def _inverse(matrix):
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1]:
        raise ExpressionError(f"inverse takes a square matrix, found {describe(matrix)}")
    return np.linalg.inv(matrix)


# name: (operation, fewest arguments, most arguments, what it is)
FUNCTIONS = {
    "abs": (np.abs, 1, 1, "magnitude of each component"),
    "clamp": (lambda a, low, high: np.clip(a, low, high), 3, 3, "clamp(a, low, high)"),
    "cross": (lambda a, b: np.cross(a, b), 2, 2, "cross product of each pixel's three components"),
    "decode_srgb": (_decode_srgb, 1, 1, "sRGB codes in [0, 1] to linear"),
    "dot": (_dot, 2, 2, "inner product of each pixel's components"),
    "dx": (lambda a: _step(a, 1), 1, 1, "change to the pixel on the right (or from the left, where that is smaller)"),
    "dy": (lambda a: _step(a, 0), 1, 1, "change to the pixel below (or from above, where that is smaller)"),
    "exp": (np.exp, 1, 1, "e to the power of a"),
    "exp2": (np.exp2, 1, 1, "2 to the power of a"),
    "floor": (np.floor, 1, 1, "largest integer that is not above"),
    "inverse": (_inverse, 1, 1, "inverse of a matrix"),
    "length": (lambda a: np.sqrt(_dot(a, a)), 1, 1, "length of each pixel's vector"),
    "log": (np.log, 1, 1, "natural logarithm"),
    "log2": (np.log2, 1, 1, "logarithm to base 2"),
    "matrix": (_matrix, 9, 16, "matrix of 9 or 16 numbers, row by row"),
    "max": (np.maximum, 2, 2, "larger of two"),
    "max_component": (_last(np.max), 1, 1, "largest component of each pixel"),
    "min": (np.minimum, 2, 2, "smaller of two"),
    "mix": (lambda a, b, t: a * (1 - t) + b * t, 3, 3, "mix(a, b, t): a (1 - t) + b t"),
    "normalize": (_normalize, 1, 1, "each pixel's vector at length 1; zero stays zero"),
    "pixel_uv": (_grid, 1, 1, "u and v of the pixels of an image; (0, 0) is the upper left corner"),
    "pow": (lambda a, b: np.power(np.maximum(a, 0), b), 2, 2, "power; a negative base counts as 0"),
    "resize": (_resize, 2, 2, "resize(a, like): a at the size of like, bilinear"),
    "saturate": (lambda a: np.clip(a, 0, 1), 1, 1, "clamp to [0, 1]"),
    "smoothstep": (_smooth, 3, 3, "smoothstep(low, high, a)"),
    "sqrt": (lambda a: np.sqrt(np.maximum(a, 0)), 1, 1, "square root; a negative number counts as 0"),
    "stack": (_stack, 1, 16, "stack(a, b, …): their components one after the other"),
    "transform": (_transform, 2, 2, "transform(matrix, a): matrix times each pixel's vector"),
    "transpose": (lambda a: np.swapaxes(a, -1, -2), 1, 1, "transpose of a matrix"),
    "where": (lambda c, a, b: np.where(c, a, b), 3, 3, "where(condition, a, b)"),
}

BINARY = {ast.Add: np.add, ast.Sub: np.subtract, ast.Mult: np.multiply, ast.Div: np.divide, ast.MatMult: np.matmul,
          ast.Pow: lambda a, b: np.power(np.asarray(a, float), b)}
COMPARE = {ast.Lt: np.less, ast.LtE: np.less_equal, ast.Gt: np.greater, ast.GtE: np.greater_equal, ast.Eq: np.equal, ast.NotEq: np.not_equal}


def describe(value):
    """What a value is, for messages."""
    shape = np.shape(value)
    kind = {0: "a number", 1: "a vector of", 2: "a matrix of", 3: "an image of", 4: "a cube map of"}[min(len(shape), 4)]
    if not shape:
        return kind
    if len(shape) == 1:
        return f"{kind} {shape[0]}"
    if len(shape) == 2:
        return f"{kind} {shape[0]} x {shape[1]}"
    return f"{kind} {shape[-2]} x {shape[-3]} pixels, {shape[-1]} component{'s' if shape[-1] != 1 else ''}"


def suggest(name, known):
    near = difflib.get_close_matches(name, sorted(known), 1)
    return f"; did you mean {near[0]}?" if near else ""


class Evaluator:
    """Computes expressions; `look_up(name, frame)` gives what a name stands for, where frame is "current" or "previous"."""

    def __init__(self, look_up):
        self.look_up = look_up

    def evaluate(self, text):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                tree = ast.parse(text.strip(), mode="eval")
        except (SyntaxError, ValueError, RecursionError) as error:
            raise ExpressionError(f"is not an expression: {getattr(error, 'msg', error)}") from None
        try:
            with np.errstate(all="ignore"):
                return self._node(tree.body, 0)
        except (TypeError, ValueError, IndexError, OverflowError, ZeroDivisionError, MemoryError) as error:
            raise ExpressionError(f"cannot be computed: {error}") from None

    def _node(self, node, depth):
        if depth > DEEPEST:
            raise ExpressionError(f"is nested deeper than {DEEPEST} levels")
        kind = getattr(self, "_" + type(node).__name__, None)
        if kind is None:
            raise ExpressionError(f"{ast.unparse(node)}: not part of the language, which has numbers, names, components (.rgb, [i]), "
                                  "+ - * / ** @, comparisons, and, or, not, and calls of functions")
        return kind(node, depth + 1)

    def _Constant(self, node, _):
        if isinstance(node.value, bool) or not isinstance(node.value, (int, float)):
            raise ExpressionError(f"{node.value!r}: only numbers may be written")
        return float(node.value)

    def _Name(self, node, _):
        if node.id in FUNCTIONS:
            raise ExpressionError(f"{node.id} is a function: {FUNCTIONS[node.id][3]}")
        return self.look_up(node.id, "current")

    def _Attribute(self, node, depth):
        if isinstance(node.value, ast.Name) and node.value.id == "previous":
            return self.look_up(node.attr, "previous")
        value = self._node(node.value, depth)
        if not set(node.attr) <= set(LETTERS) or len(node.attr) > 4:
            raise ExpressionError(f".{node.attr} is no component; expected letters of rgba or xyzw")
        count = np.shape(value)[-1] if np.ndim(value) in (1, 3, 4) else 0
        picks = [LETTERS[letter] for letter in node.attr]
        if max(picks) >= count:
            raise ExpressionError(f"{ast.unparse(node)}: {ast.unparse(node.value)} is {describe(value)}, and has no .{node.attr[picks.index(max(picks))]}")
        if np.ndim(value) == 1 and len(picks) == 1:
            return value[picks[0]]
        return value[..., picks]

    def _Subscript(self, node, depth):
        value = self._node(node.value, depth)
        index = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        if not all(isinstance(i, ast.Constant) and type(i.value) is int and i.value >= 0 for i in index):
            raise ExpressionError(f"{ast.unparse(node)}: an index is a number from 0")
        index = [i.value for i in index]
        if np.ndim(value) not in (1, 2) or len(index) != np.ndim(value) or any(i >= n for i, n in zip(index, np.shape(value))):
            raise ExpressionError(f"{ast.unparse(node)}: {ast.unparse(node.value)} is {describe(value)}")
        return value[tuple(index)]

    def _binary(self, node, operation, left, right):
        try:
            return operation(left, right)
        except ValueError:
            raise ExpressionError(f"{ast.unparse(node)}: sizes do not match, {describe(left)} and {describe(right)}") from None

    def _BinOp(self, node, depth):
        if type(node.op) not in BINARY:
            raise ExpressionError(f"{ast.unparse(node)}: expected one of + - * / ** @")
        return self._binary(node, BINARY[type(node.op)], self._node(node.left, depth), self._node(node.right, depth))

    def _UnaryOp(self, node, depth):
        value = self._node(node.operand, depth)
        if isinstance(node.op, ast.USub):
            return -value
        if isinstance(node.op, ast.UAdd):
            return value
        if isinstance(node.op, ast.Not):
            return np.logical_not(value)
        raise ExpressionError(f"{ast.unparse(node)}: expected - or not")

    def _Compare(self, node, depth):
        values = [self._node(n, depth) for n in [node.left, *node.comparators]]
        result = True
        for op, left, right in zip(node.ops, values, values[1:]):
            if type(op) not in COMPARE:
                raise ExpressionError(f"{ast.unparse(node)}: expected one of < <= > >= == !=")
            result = np.logical_and(result, self._binary(node, COMPARE[type(op)], left, right))
        return result

    def _BoolOp(self, node, depth):
        values = [self._node(n, depth) for n in node.values]
        operation = np.logical_and if isinstance(node.op, ast.And) else np.logical_or
        result = values[0]
        for value in values[1:]:
            result = self._binary(node, operation, result, value)
        return result

    def _Call(self, node, depth):
        name = node.func.id if isinstance(node.func, ast.Name) else None
        if name not in FUNCTIONS:
            raise ExpressionError(f"{ast.unparse(node.func)} is no function{suggest(name or '', FUNCTIONS)}")
        operation, fewest, most, meaning = FUNCTIONS[name]
        if node.keywords or any(isinstance(a, ast.Starred) for a in node.args) or not fewest <= len(node.args) <= most:
            count = str(fewest) if fewest == most else f"{fewest} to {most}"
            raise ExpressionError(f"{ast.unparse(node)}: {name} takes {count} values ({meaning})")
        values = [np.asarray(self._node(a, depth), None) for a in node.args]
        try:
            return operation(*values)
        except (ValueError, IndexError, np.linalg.LinAlgError) as error:
            found = ", ".join(describe(v) for v in values)
            raise ExpressionError(f"{ast.unparse(node)}: {error} (found {found})") from None
