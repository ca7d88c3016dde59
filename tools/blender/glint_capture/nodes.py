"""Arithmetic in a shader's node tree, written as arithmetic."""


class Value:
    """A number (`scalar`) or a vector that nodes compute."""

    def __init__(self, tree, socket, scalar):
        self.tree, self.socket, self.scalar = tree, socket, scalar

    def __add__(self, other):
        return self._both("ADD", other)

    def __sub__(self, other):
        return self._both("SUBTRACT", other)

    def __neg__(self):
        return self * -1.0

    def __mul__(self, other):
        return self._both("MULTIPLY", other)

    def dot(self, other):
        return math(self.tree, True, "DOT_PRODUCT", self, other)

    def cross(self, other):
        return math(self.tree, True, "CROSS_PRODUCT", self, other)

    def unit(self):
        return math(self.tree, True, "NORMALIZE", self)

    def root(self):
        return math(self.tree, False, "SQRT", self.at_least(0.0))

    def at_least(self, lowest):
        return math(self.tree, False, "MAXIMUM", self, lowest)

    def above(self, other):
        return math(self.tree, False, "GREATER_THAN", self, other)

    def sine(self):
        return math(self.tree, False, "SINE", self)

    def cosine(self):
        return math(self.tree, False, "COSINE", self)

    def _both(self, operation, other):
        return math(self.tree, not (self.scalar and not _is_vector(other)), operation, self, other)


def _is_vector(value):
    return isinstance(value, tuple) or (isinstance(value, Value) and not value.scalar)


def math(tree, vector, operation, *operands):
    """One node. A scalar beside a vector counts for each component."""
    node = tree.nodes.new("ShaderNodeVectorMath" if vector else "ShaderNodeMath")
    node.operation = operation
    for socket, operand in zip(node.inputs, operands):
        if isinstance(operand, Value):
            tree.links.new(operand.socket, socket)
        else:
            socket.default_value = (operand,) * 3 if vector and isinstance(operand, float) else operand
    if vector and operation == "DOT_PRODUCT":
        return Value(tree, node.outputs["Value"], True)
    return Value(tree, node.outputs[0], not vector)


def node(tree, kind, **inputs):
    """A node of another kind, with its inputs by name."""
    made = tree.nodes.new(kind)
    for name, value in inputs.items():
        tree.links.new(value.socket, made.inputs[name])
    return made
