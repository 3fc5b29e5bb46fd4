"""Expression tracing: record scalar arithmetic and emit a flat function.

NumPy is slow on small vectors: one call costs as much as fifty scalar
multiplications. Formulas written for floats run once on traced numbers;
constants are folded, common subexpressions are shared, and the result is
emitted as the source of one function without loops.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Sequence
from hashlib import sha256
from math import cos, sin
from typing import Any, NamedTuple

from ..core.compilation import compiled, shared

Function = Callable[..., tuple[float, ...]]
DEPTH = 12  # nesting of an expression before it is assigned to a variable


class TracedNumber:
    """Node of an expression graph.

    Attributes:
        operation: Name of a variable, or one of ``+ - * / neg sin cos``.
        operands: Operands; floats are constants.
        hint: Value at the point of tracing, for the choice of pivots.
    """

    __slots__ = ("_trace", "hint", "operands", "operation")

    def __init__(
        self,
        trace: ExpressionTrace,
        operation: str,
        operands: tuple[TracedNumber | float, ...],
        hint: float,
    ) -> None:
        """Make a node; only :class:`ExpressionTrace` calls this."""
        self._trace = trace
        self.operation, self.operands = operation, operands
        self.hint = hint

    def _is(self, operation: str) -> bool:
        return self.operation == operation

    def __neg__(self) -> TracedNumber | float:
        if self._is("neg"):
            return self.operands[0]
        if self._is("-"):
            return self.operands[1] - self.operands[0]
        return self._trace.make("neg", (self,), -self.hint)

    def __add__(self, other: TracedNumber | float) -> TracedNumber | float:
        if isinstance(other, TracedNumber):
            if other._is("neg"):
                return self - other.operands[0]
            if self._is("neg"):
                return other - self.operands[0]
        elif other == 0.0:
            return self
        elif self._is("neg"):
            return other - self.operands[0]
        elif self._is("+") and isinstance(self.operands[1], float):
            return self.operands[0] + (self.operands[1] + other)
        hint = self.hint + hint_of(other)
        return self._trace.make("+", (self, other), hint)

    __radd__ = __add__

    def __sub__(self, other: TracedNumber | float) -> TracedNumber | float:
        if isinstance(other, TracedNumber):
            if other is self:
                return 0.0
            if other._is("neg"):
                return self + other.operands[0]
        else:
            return self + -other
        if self._is("neg"):
            return -(self.operands[0] + other)
        hint = self.hint - hint_of(other)
        return self._trace.make("-", (self, other), hint)

    def __rsub__(self, other: float) -> TracedNumber | float:
        if other == 0.0:
            return -self
        if self._is("neg"):
            return self.operands[0] + other
        return self._trace.make("-", (other, self), other - self.hint)

    def __mul__(self, other: TracedNumber | float) -> TracedNumber | float:
        if self._is("neg"):
            return -(self.operands[0] * other)
        if isinstance(other, TracedNumber):
            if other._is("neg"):
                return -(self * other.operands[0])
        elif other == 0.0:
            return 0.0
        elif other < 0.0:
            return -(self * -other)
        elif other == 1.0:
            return self
        hint = self.hint * hint_of(other)
        return self._trace.make("*", (self, other), hint)

    __rmul__ = __mul__

    def __truediv__(self, other: TracedNumber | float) -> TracedNumber | float:
        if not isinstance(other, TracedNumber):
            return self * (1.0 / other)
        if other is self:
            return 1.0
        if self._is("neg"):
            return -(self.operands[0] / other)
        if other._is("neg"):
            return -(self / other.operands[0])
        return self._trace.make(
            "/", (self, other), self.hint / (other.hint or 1.0)
        )

    def __rtruediv__(self, other: float) -> TracedNumber | float:
        if other == 0.0:
            return 0.0
        if self._is("neg"):
            return -(other / self.operands[0])
        return self._trace.make("/", (other, self), other / (self.hint or 1.0))

    def apply(
        self, name: str, function: Callable[[float], float]
    ) -> TracedNumber:
        """Apply a named function of one argument."""
        return self._trace.make(name, (self,), function(self.hint))

    def sin(self) -> TracedNumber:
        """Return the sine; NumPy calls this for arrays of numbers."""
        return self.apply("sin", sin)

    def cos(self) -> TracedNumber:
        """Return the cosine; NumPy calls this for arrays of numbers."""
        return self.apply("cos", cos)


class Formula(NamedTuple):
    """Generated function of floats, as source.

    Attributes:
        name: Name of the function.
        text: Its definition.
    """

    name: str
    text: str

    def function(self) -> Function:
        """Return the function in Python."""
        function: Function = self._names()[self.name]
        return function

    def loop(self, name: str, text: str) -> Any:
        """Return a compiled loop over rows that calls the function.

        Args:
            name: Name of the loop.
            text: Its definition.
        """
        names = self._names(text)
        # Symbols of kept machine code: those of several robots must differ.
        digest = sha256(f"{self.text}{text}".encode()).hexdigest()[:16]
        for each in (self.name, name):
            names[each].__qualname__ = f"{each}_{digest}"
        shared(names[self.name])
        return compiled(names[name])

    def _names(self, loop: str = "") -> dict[str, Any]:
        """Return the names that the definition, and a loop, define."""
        names: dict[str, Any] = {"sin": sin, "cos": cos, "__name__": __name__}
        text = f"{self.text}\n\n{loop}"
        exec(compile(text, f"<{self.name}>", "exec"), names)
        return names


class ExpressionTrace:
    """Expression graph of a function and its arguments."""

    def __init__(self) -> None:
        """Make a trace without variables."""
        self._nodes: dict[tuple[object, ...], TracedNumber] = {}
        self._names: list[str] = []

    def variable(self, name: str, hint: float = 0.0) -> TracedNumber:
        """Add an argument of the function; ``hint`` is a typical value."""
        self._names.append(name)
        return TracedNumber(self, name, (), hint)

    def make(
        self, operation: str, operands: tuple[Number, ...], hint: float
    ) -> TracedNumber:
        """Return the node of an operation; equal nodes are one object."""
        keys = [x if isinstance(x, float) else id(x) for x in operands]
        if operation in "+*":
            keys.sort(key=str)
        node = self._nodes.get((operation, *keys))
        if node is None:
            node = TracedNumber(self, operation, operands, hint)
            self._nodes[(operation, *keys)] = node
        return node

    def source(self, name: str, results: Sequence[Number]) -> str:
        """Return the source of the function that computes ``results``."""
        uses = _count_uses(results)
        lines: list[tuple[str, str]] = []  # name, text
        texts: dict[int, tuple[str, int]] = {}

        def write(number: Number) -> tuple[str, int]:
            """Return the text of a number and its nesting depth."""
            if not isinstance(number, TracedNumber):
                return repr(float(number)), 0
            if not number.operands:
                return number.operation, 0
            if id(number) in texts:
                return texts[id(number)]
            parts = [write(operand) for operand in number.operands]
            text = _format(number.operation, [part for part, _ in parts])
            depth = 1 + max(depth for _, depth in parts)
            if uses[id(number)] > 1 or depth > DEPTH:
                lines.append((f"v{len(lines)}_", text))
                text, depth = lines[-1][0], 0
            texts[id(number)] = (text, depth)
            return texts[id(number)]

        written = ", ".join(write(result)[0] for result in results)
        lines.append(("return", f"({written},)"))
        head = f"def {name}({', '.join(self._names)}):"
        return "\n".join([head, *_reuse_variables(lines), ""])

    def formula(self, name: str, results: Sequence[Number]) -> Formula:
        """Return the function that computes ``results``, not compiled yet.

        Its arguments are the variables, in the order of their definition.
        """
        return Formula(name, self.source(name, results))


Number = TracedNumber | float


def hint_of(number: Number) -> float:
    """Return the value of a number at the point of tracing."""
    return number.hint if isinstance(number, TracedNumber) else number


def sine(angle: Number) -> Number:
    """Return the sine of an angle, in [rad]."""
    return angle.sin() if isinstance(angle, TracedNumber) else sin(angle)


def cosine(angle: Number) -> Number:
    """Return the cosine of an angle, in [rad]."""
    return angle.cos() if isinstance(angle, TracedNumber) else cos(angle)


def _count_uses(results: Sequence[Number]) -> Counter[int]:
    uses: Counter[int] = Counter()
    pending = [r for r in results if isinstance(r, TracedNumber)]
    while pending:
        number = pending.pop()
        uses[id(number)] += 1
        if uses[id(number)] == 1:
            pending += [
                x for x in number.operands if isinstance(x, TracedNumber)
            ]
    return uses


def _reuse_variables(lines: list[tuple[str, str]]) -> list[str]:
    """Assign to a variable again after its last use.

    Objects that are freed early leave memory in the cache for later ones.
    """
    last = {
        name: i
        for i, (_, text) in enumerate(lines)
        for name in re.findall(r"v\d+_", text)
    }
    idle: list[str] = []
    names: dict[str, str] = {}
    written = []
    for i, (name, text) in enumerate(lines):
        used = dict.fromkeys(re.findall(r"v\d+_", text))
        text = re.sub(r"v\d+_", lambda found: names[found[0]], text)
        idle += [names[old] for old in used if last[old] == i]
        if name == "return":
            written.append(f"    return {text}")
            continue
        names[name] = idle.pop() if idle else f"v{len(names)}"
        written.append(f"    {names[name]} = {text}")
    return written


def _format(operation: str, parts: list[str]) -> str:
    if operation in ("sin", "cos"):
        return f"{operation}({parts[0]})"
    if operation == "neg":
        return f"(-{parts[0]})"
    return f"({parts[0]} {operation} {parts[1]})"
