"""Translation of loops over arrays from Python to LLVM assembly.

The subset of Python is small: floats, integers, and arrays of them by
element; ``for`` over ``range``, ``if``, ``return``; arithmetic, comparisons,
``abs``, ``min``, ``max``, ``sqrt``, ``sin``, ``cos``, ``tan``, ``atan2`` and
``fma``, which rounds a x + b once; calls of formulas, which are functions of
floats without branches that return a tuple of floats. Operations keep their
order and nothing else is fused, so that results have the bits of Python. Only
divisions by zero differ: they give inf or NaN, which a loop has to reject.
Both sides of ``and``, ``or`` and conditional expressions are evaluated.
"""

import ast
import struct
from typing import NamedTuple

DOUBLE, INTEGER, TRUTH = "double", "i64", "i1"
HEAD = """\
declare double @sin(double)
declare double @cos(double)
declare double @tan(double)
declare double @atan2(double, double)
declare double @llvm.fabs.f64(double)
declare double @llvm.fma.f64(double, double, double)
declare double @llvm.sqrt.f64(double)
"""
LIBRARY = {
    "sin": "sin",
    "cos": "cos",
    "tan": "tan",
    "atan2": "atan2",
    "abs": "llvm.fabs.f64",
    "fma": "llvm.fma.f64",
    "sqrt": "llvm.sqrt.f64",
}
FLOAT_OPERATIONS = {
    ast.Add: "fadd",
    ast.Sub: "fsub",
    ast.Mult: "fmul",
    ast.Div: "fdiv",
}
INTEGER_OPERATIONS = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul"}
FLOAT_COMPARISONS = {
    ast.Lt: "olt",
    ast.LtE: "ole",
    ast.Gt: "ogt",
    ast.GtE: "oge",
    ast.Eq: "oeq",
    ast.NotEq: "une",
}
INTEGER_COMPARISONS = {
    ast.Lt: "slt",
    ast.LtE: "sle",
    ast.Gt: "sgt",
    ast.GtE: "sge",
    ast.Eq: "eq",
    ast.NotEq: "ne",
}


class _Value(NamedTuple):
    """Operand of an instruction."""

    kind: str
    text: str


class _ArrayMemory(NamedTuple):
    """Array in memory; a formula's results have one dimension."""

    kind: str
    pointer: str
    shape: tuple[str, ...]


def translate(source: str, arguments: str) -> str:
    """Return the assembly of formulas and of the loop that calls them.

    The loop becomes the function ``kernel`` of a frame: an array of 64-bit
    words, for each argument the address of an array and its shape, or the
    bits of a float. It returns an integer.

    Args:
        source: Definitions of formulas, then of the loop.
        arguments: One letter for each argument of the loop: the number of
            dimensions of floats, or "i" for a row of integers.

    Raises:
        NotImplementedError: If the source is beyond the subset.
    """
    *formulas, loop = [
        node
        for node in ast.parse(source).body
        if isinstance(node, ast.FunctionDef)
    ]
    known: dict[str, int] = {}
    parts = [HEAD]
    for formula in formulas:
        parts.append(_translate_formula(formula, known))
    parts.append(_Loop(known).translate(loop, arguments))
    return "\n".join(parts)


def _translate_formula(formula: ast.FunctionDef, known: dict[str, int]) -> str:
    """Return the assembly of a formula; note how many results it has."""
    *assignments, last = formula.body
    if not (
        isinstance(last, ast.Return) and isinstance(last.value, ast.Tuple)
    ):
        raise _beyond(last)
    names = [argument.arg for argument in formula.args.args]
    function = _Function(known)
    function.values = {name: _Value(DOUBLE, f"%{name}") for name in names}
    for statement in assignments:
        if not isinstance(statement, ast.Assign):
            raise _beyond(statement)
        (target,) = statement.targets
        if not isinstance(target, ast.Name):
            raise _beyond(target)
        function.values[target.id] = function.float_of(statement.value)
    for i, element in enumerate(last.value.elts):
        value = function.float_of(element)
        at = function.add(f"getelementptr double, ptr %results, i64 {i}")
        function.lines.append(f"store double {value.text}, ptr {at}")
    known[formula.name] = len(last.value.elts)
    columns = "".join(f", double %{name}" for name in names)
    return "\n".join(
        [
            f"define void @{formula.name}(ptr %results{columns}) {{",
            *function.lines,
            "ret void",
            "}",
        ]
    )


class _Function:
    """Expressions of one function, as instructions.

    Attributes:
        lines: Instructions so far.
        head: Instructions before them, which allocate memory.
        values: Values of names that are assigned once.
        variables: Memory of variables.
        blocks: Arrays.
    """

    def __init__(self, formulas: dict[str, int]) -> None:
        """Begin empty; formulas have numbers of results."""
        self._formulas = formulas
        self._count = 0
        self.lines: list[str] = []
        self.head: list[str] = []
        self.values: dict[str, _Value] = {}
        self.variables: dict[str, _Value] = {}
        self.blocks: dict[str, _ArrayMemory] = {}

    def name(self) -> str:
        """Return a new name."""
        self._count += 1
        return f"t.{self._count}"

    def add(self, instruction: str) -> str:
        """Add an instruction; return the name of its result."""
        result = f"%{self.name()}"
        self.lines.append(f"{result} = {instruction}")
        return result

    def allocate(self, kind: str) -> str:
        """Return the address of new memory."""
        result = f"%{self.name()}"
        self.head.append(f"{result} = alloca {kind}")
        return result

    def float_of(self, node: ast.expr) -> _Value:
        """Translate an expression to a float."""
        value = self.value_of(node)
        if value.kind != DOUBLE:
            text = self.add(f"sitofp {value.kind} {value.text} to double")
            value = _Value(DOUBLE, text)
        return value

    def integer_of(self, node: ast.expr) -> str:
        """Translate an expression that must be an integer."""
        value = self.value_of(node)
        if value.kind != INTEGER:
            raise _beyond(node)
        return value.text

    def truth_of(self, node: ast.expr) -> str:
        """Translate an expression that must be a condition."""
        value = self.value_of(node)
        if value.kind != TRUTH:
            raise _beyond(node)
        return value.text

    def value_of(self, node: ast.expr) -> _Value:
        """Translate an expression."""
        match node:
            case ast.Constant(value=float(number)):
                bits = struct.unpack("<Q", struct.pack("<d", number))[0]
                return _Value(DOUBLE, f"0x{bits:016X}")
            case ast.Constant(value=int(number)):
                return _Value(INTEGER, str(number))
            case ast.Name(id=name) if name in self.values:
                return self.values[name]
            case ast.Name(id=name) if name in self.variables:
                kind, at = self.variables[name]
                return _Value(kind, self.add(f"load {kind}, ptr {at}"))
            case ast.Subscript():
                return self._element(node)
            case ast.BinOp(left=left, op=op, right=right):
                return self._operation(left, op, right)
            case ast.UnaryOp(op=op, operand=operand):
                return self._unary(op, operand)
            case ast.Compare():
                return self._comparison(node)
            case ast.BoolOp(op=op, values=parts):
                word = "and" if isinstance(op, ast.And) else "or"
                return self._joined(word, [self.truth_of(x) for x in parts])
            case ast.IfExp(test=test, body=body, orelse=other):
                first, second = self._alike([body, other])
                return self._select(self.truth_of(test), first, second)
            case ast.Call(func=ast.Name(id=name), args=arguments):
                return self._call(name, arguments)
        raise _beyond(node)

    def place_of(self, node: ast.Subscript) -> tuple[str, str]:
        """Return the kind and the address of an element."""
        if not isinstance(node.value, ast.Name):
            raise _beyond(node)
        kind, pointer, shape = self.blocks[node.value.id]
        by = node.slice
        indices = by.elts if isinstance(by, ast.Tuple) else [by]
        at = self.integer_of(indices[0])
        if len(indices) != len(shape):
            raise _beyond(node)
        if len(indices) == 2:
            row = self.add(f"mul i64 {at}, {shape[1]}")
            column = self.integer_of(indices[1])
            at = self.add(f"add i64 {row}, {column}")
        return kind, self.add(f"getelementptr {kind}, ptr {pointer}, i64 {at}")

    def results_of(self, name: str, arguments: list[ast.expr]) -> _ArrayMemory:
        """Call a formula; return its results."""
        count = self._formulas[name]
        pointer = self.allocate(f"[{count} x double]")
        values = [self.float_of(argument).text for argument in arguments]
        passed = "".join(f", double {value}" for value in values)
        self.lines.append(f"call void @{name}(ptr {pointer}{passed})")
        return _ArrayMemory(DOUBLE, pointer, (str(count),))

    def _element(self, node: ast.Subscript) -> _Value:
        match node:
            case ast.Subscript(
                value=ast.Attribute(value=ast.Name(id=name), attr="shape"),
                slice=ast.Constant(value=int(axis)),
            ):
                return _Value(INTEGER, self.blocks[name].shape[axis])
        kind, at = self.place_of(node)
        return _Value(kind, self.add(f"load {kind}, ptr {at}"))

    def _alike(self, nodes: list[ast.expr]) -> list[_Value]:
        """Translate expressions to values of one kind."""
        values = [self.value_of(node) for node in nodes]
        if len({value.kind for value in values}) > 1:
            values = [self.float_of(node) for node in nodes]
        return values

    def operate(self, left: _Value, op: ast.operator, right: _Value) -> _Value:
        """Return the result of an operation on values of one kind."""
        kind = left.kind
        table = FLOAT_OPERATIONS if kind == DOUBLE else INTEGER_OPERATIONS
        if type(op) not in table:
            raise _beyond(op)
        word = table[type(op)]
        text = self.add(f"{word} {kind} {left.text}, {right.text}")
        return _Value(kind, text)

    def _operation(
        self, left: ast.expr, op: ast.operator, right: ast.expr
    ) -> _Value:
        first, second = self._alike([left, right])
        return self.operate(first, op, second)

    def _unary(self, op: ast.unaryop, operand: ast.expr) -> _Value:
        value = self.value_of(operand)
        match op, value.kind:
            case ast.USub(), "double":
                return _Value(DOUBLE, self.add(f"fneg double {value.text}"))
            case ast.USub(), "i64":
                return _Value(INTEGER, self.add(f"sub i64 0, {value.text}"))
            case ast.Not(), "i1":
                return _Value(TRUTH, self.add(f"xor i1 {value.text}, true"))
        raise _beyond(operand)

    def _comparison(self, node: ast.Compare) -> _Value:
        """Translate a comparison, also a chained one."""
        values = self._alike([node.left, *node.comparators])
        kind = values[0].kind
        word, table = "icmp", INTEGER_COMPARISONS
        if kind == DOUBLE:
            word, table = "fcmp", FLOAT_COMPARISONS
        found = []
        for left, op, right in zip(
            values[:-1], node.ops, values[1:], strict=True
        ):
            if type(op) not in table:
                raise _beyond(op)
            how = f"{word} {table[type(op)]} {kind}"
            found.append(self.add(f"{how} {left.text}, {right.text}"))
        return self._joined("and", found)

    def _joined(self, word: str, truths: list[str]) -> _Value:
        result = truths[0]
        for other in truths[1:]:
            result = self.add(f"{word} i1 {result}, {other}")
        return _Value(TRUTH, result)

    def _select(self, test: str, first: _Value, second: _Value) -> _Value:
        kind = first.kind
        text = self.add(
            f"select i1 {test}, {kind} {first.text}, {kind} {second.text}"
        )
        return _Value(kind, text)

    def _call(self, name: str, arguments: list[ast.expr]) -> _Value:
        if name in ("min", "max"):
            best, *others = self._alike(arguments)
            how = {"min": "lt", "max": "gt"}[name]
            floats = best.kind == DOUBLE
            test = f"fcmp o{how}" if floats else f"icmp s{how}"
            for other in others:  # Python keeps the first of equals
                better = self.add(
                    f"{test} {best.kind} {other.text}, {best.text}"
                )
                best = self._select(better, other, best)
            return best
        if name in LIBRARY:
            values = [self.float_of(each).text for each in arguments]
            passed = ", ".join(f"double {value}" for value in values)
            called = f"call double @{LIBRARY[name]}({passed})"
            return _Value(DOUBLE, self.add(called))
        raise NotImplementedError(f"a call of {name}")


class _Loop(_Function):
    """Statements of a loop over arrays, as instructions."""

    def __init__(self, formulas: dict[str, int]) -> None:
        """Begin empty; formulas have numbers of results."""
        super().__init__(formulas)
        self._ended = False  # whether the last instruction leaves its block

    def translate(self, loop: ast.FunctionDef, arguments: str) -> str:
        """Return the assembly; see :func:`translate`."""
        names = [argument.arg for argument in loop.args.args]
        words = iter(range(3 * len(names)))

        def word(kind: str) -> str:
            at = self.add(f"getelementptr i64, ptr %frame, i64 {next(words)}")
            return self.add(f"load {kind}, ptr {at}")

        for name, letter in zip(names, arguments, strict=True):
            if letter == "0":
                self.values[name] = _Value(DOUBLE, word(DOUBLE))
                continue
            kind = INTEGER if letter == "i" else DOUBLE
            pointer = word("ptr")
            sizes = range(1 if letter == "i" else int(letter))
            shape = tuple(word(INTEGER) for _ in sizes)
            self.blocks[name] = _ArrayMemory(kind, pointer, shape)
        self._run(loop.body)
        if not self._ended:
            self.lines.append("ret i64 0")
        return "\n".join(
            [
                "define i64 @kernel(ptr %frame) {",
                *self.head,
                *self.lines,
                "}",
            ]
        )

    def _run(self, statements: list[ast.stmt]) -> None:
        for statement in statements:
            self._statement(statement)

    def _statement(self, node: ast.stmt) -> None:
        match node:
            case ast.Expr(value=ast.Constant()):  # a docstring
                pass
            case ast.Assign(targets=targets, value=value):
                for target in targets:
                    self._assign(target, value)
            case ast.AugAssign(target=target, op=op, value=value):
                first = self.value_of(target)
                second = self.value_of(value)
                if second.kind != first.kind:
                    second = self.float_of(value)
                self._store(target, self.operate(first, op, second))
            case ast.For(
                target=ast.Name(id=name),
                iter=ast.Call(func=ast.Name(id="range"), args=limits),
                body=body,
            ):
                self._repeat(name, limits, body)
            case ast.If(test=test, body=body, orelse=other):
                self._branch(self.truth_of(test), body, other)
            case ast.Return(value=value):
                text = "0" if value is None else self.integer_of(value)
                self.lines.append(f"ret i64 {text}")
                self._ended = True
            case _:
                raise _beyond(node)

    def _assign(self, target: ast.expr, value: ast.expr) -> None:
        match target, value:
            case ast.Tuple(elts=targets), ast.Tuple(elts=values):
                found = [self.value_of(each) for each in values]
                for each, result in zip(targets, found, strict=True):
                    self._store(each, result)
            case (
                ast.Name(id=name),
                ast.Call(func=ast.Name(id=called), args=arguments),
            ) if called in self._formulas:
                self.blocks[name] = self.results_of(called, arguments)
            case _:
                self._store(target, self.value_of(value))

    def _store(self, target: ast.expr, value: _Value) -> None:
        match target:
            case ast.Name(id=name):
                if name not in self.variables:
                    at = self.allocate(value.kind)
                    self.variables[name] = _Value(value.kind, at)
                kind, at = self.variables[name]
            case ast.Subscript():
                kind, at = self.place_of(target)
            case _:
                raise _beyond(target)
        if kind != value.kind:
            raise _beyond(target)
        self.lines.append(f"store {kind} {value.text}, ptr {at}")

    def _begin(self, label: str) -> None:
        """Begin a basic block, to which the one before it goes on."""
        if not self._ended:
            self.lines.append(f"br label %{label}")
        self.lines.append(f"{label}:")
        self._ended = False

    def _repeat(
        self, name: str, limits: list[ast.expr], body: list[ast.stmt]
    ) -> None:
        first = self.integer_of(limits[0]) if len(limits) == 2 else "0"
        end = self.integer_of(limits[-1])
        self._store(ast.Name(id=name), _Value(INTEGER, first))
        at = self.variables[name].text
        test, inside, after = (f"b.{self.name()}" for _ in range(3))
        self._begin(test)
        i = self.add(f"load i64, ptr {at}")
        more = self.add(f"icmp slt i64 {i}, {end}")
        self.lines.append(f"br i1 {more}, label %{inside}, label %{after}")
        self._ended = True
        self._begin(inside)
        self._run(body)
        if not self._ended:
            i = self.add(f"load i64, ptr {at}")
            following = self.add(f"add i64 {i}, 1")
            self.lines.append(f"store i64 {following}, ptr {at}")
            self.lines.append(f"br label %{test}")
        self._ended = True
        self._begin(after)

    def _branch(
        self, test: str, body: list[ast.stmt], other: list[ast.stmt]
    ) -> None:
        inside, outside, after = (f"b.{self.name()}" for _ in range(3))
        self.lines.append(f"br i1 {test}, label %{inside}, label %{outside}")
        self._ended = True
        for label, statements in ((inside, body), (outside, other)):
            self._begin(label)
            self._run(statements)
            if not self._ended:
                self.lines.append(f"br label %{after}")
            self._ended = True
        self._begin(after)


def _beyond(node: ast.AST) -> NotImplementedError:
    """Return the error of a construct beyond the subset."""
    line = getattr(node, "lineno", None)
    return NotImplementedError(f"{type(node).__name__} in line {line}")
