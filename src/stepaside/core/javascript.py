"""Translation of formulas and loops over arrays from Python to JavaScript.

The subset is that of :mod:`.llvm_assembly`: floats, integers, booleans, and
arrays of one or two dimensions by element; ``for`` over ``range``, ``if``,
``return``; arithmetic, comparisons, ``abs``, ``min``, ``max``, ``sin``,
``cos``, ``sqrt`` and ``atan2``; calls of functions that are translated, too.
An array becomes a typed array, row by row, with the property ``shape``.
Operations keep their order.
"""

import ast
from collections.abc import Mapping

LIBRARY = {
    name: f"Math.{name}"
    for name in ("abs", "min", "max", "sin", "cos", "sqrt", "atan2")
}
OPERATORS: dict[type[ast.AST], str] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "===",
    ast.NotEq: "!==",
    ast.And: "&&",
    ast.Or: "||",
    ast.USub: "-",
    ast.Not: "!",
}


def javascript_of(
    source: str, constants: Mapping[str, float] | None = None
) -> str:
    """Return functions of Python as functions of JavaScript.

    Args:
        source: Definitions of functions.
        constants: Values of global names.

    Raises:
        NotImplementedError: If the source is beyond the subset.
    """
    functions = ast.parse(source).body
    return "\n".join(
        _FunctionText(constants or {}).translate(function)
        for function in functions
    )


class _FunctionText:
    """Statements of one function, as lines of JavaScript."""

    def __init__(self, constants: Mapping[str, float]) -> None:
        """Begin without variables."""
        self._constants = constants
        self._variables: dict[str, None] = {}  # in the order of assignment

    def translate(self, node: ast.stmt) -> str:
        """Return the function of a definition."""
        if not isinstance(node, ast.FunctionDef):
            raise _beyond(node)
        names = [argument.arg for argument in node.args.args]
        body = self._block(node.body)
        own = ", ".join(n for n in self._variables if n not in names)
        declared = [f"let {own};"] if own else []
        head = f"function {node.name}({', '.join(names)}) {{"
        return "\n".join([head, *declared, *body, "}"])

    def _block(self, statements: list[ast.stmt]) -> list[str]:
        return [line for each in statements for line in self._statement(each)]

    def _statement(self, node: ast.stmt) -> list[str]:
        match node:
            case ast.Expr(value=ast.Constant()):  # a docstring
                return []
            case ast.Return(value=None):
                return ["return;"]
            case ast.Return(value=value) if value is not None:
                return [f"return {self._expression(value)};"]
            case ast.Assign(targets=targets, value=value):
                return self._assignment(targets, value)
            case ast.AugAssign(target=target, op=op, value=value):
                place, sign = self._target(target), _operator(op)
                return [f"{place} {sign}= {self._expression(value)};"]
            case ast.For(
                target=ast.Name(id=name),
                iter=ast.Call(func=ast.Name(id="range"), args=limits),
                body=body,
            ):
                self._variables[name] = None
                numbers = [self._expression(limit) for limit in limits]
                first, end = ["0", *numbers][-2:]
                head = f"for ({name} = {first}; {name} < {end}; {name}++) {{"
                return [head, *self._block(body), "}"]
            case ast.If(test=test, body=body, orelse=others):
                head = f"if ({self._expression(test)}) {{"
                middle = ["} else {", *self._block(others)] if others else []
                return [head, *self._block(body), *middle, "}"]
        raise _beyond(node)

    def _assignment(
        self, targets: list[ast.expr], value: ast.expr
    ) -> list[str]:
        match targets, value:
            case [ast.Tuple(elts=places)], ast.Tuple(elts=values):
                left = ", ".join(map(self._target, places))
                right = ", ".join(map(self._expression, values))
                return [f"[{left}] = [{right}];"]
        names = " = ".join(map(self._target, targets))
        return [f"{names} = {self._expression(value)};"]

    def _target(self, node: ast.expr) -> str:
        match node:
            case ast.Name(id=name):
                self._variables[name] = None
                return name
            case ast.Subscript():
                return self._expression(node)
        raise _beyond(node)

    def _expression(self, node: ast.expr) -> str:
        match node:
            case ast.Constant(value=bool(truth)):
                return "true" if truth else "false"
            case ast.Constant(value=float() | int() as number):
                return repr(number)
            case ast.Name(id=name):
                value = self._constants.get(name)
                return name if value is None else repr(value)
            case ast.Tuple(elts=parts):
                return f"[{', '.join(map(self._expression, parts))}]"
            case ast.BinOp(left=left, op=op, right=right):
                return self._joined(op, [left, right])
            case ast.BoolOp(op=op, values=parts):
                return self._joined(op, parts)
            case ast.UnaryOp(op=op, operand=operand):
                return f"({_operator(op)}{self._expression(operand)})"
            case ast.Compare(left=left, ops=signs, comparators=others):
                pairs = zip([left, *others[:-1]], signs, others, strict=True)
                tests = [self._joined(op, [a, b]) for a, op, b in pairs]
                return f"({' && '.join(tests)})"
            case ast.IfExp(test=test, body=one, orelse=other):
                return (
                    f"({self._expression(test)} ? {self._expression(one)} : "
                    f"{self._expression(other)})"
                )
            case ast.Call(func=ast.Name(id=name), args=arguments):
                called = LIBRARY.get(name, name)
                given = ", ".join(map(self._expression, arguments))
                return f"{called}({given})"
            case ast.Subscript(value=array, slice=index):
                return self._element(array, index)
        raise _beyond(node)

    def _joined(self, op: ast.AST, parts: list[ast.expr]) -> str:
        sign = f" {_operator(op)} "
        return f"({sign.join(map(self._expression, parts))})"

    def _element(self, array: ast.expr, index: ast.expr) -> str:
        match array, index:
            case ast.Name(id=name), ast.Tuple(elts=[row, column]):
                i, j = self._expression(row), self._expression(column)
                return f"{name}[({i}) * {name}.shape[1] + {j}]"
            case ast.Name(id=name), _:
                return f"{name}[{self._expression(index)}]"
            case ast.Attribute(value=ast.Name(id=name), attr="shape"), _:
                return f"{name}.shape[{self._expression(index)}]"
        raise _beyond(array)


def _operator(node: ast.AST) -> str:
    if type(node) not in OPERATORS:
        raise _beyond(node)
    return OPERATORS[type(node)]


def _beyond(node: ast.AST) -> NotImplementedError:
    """Return the error of a construct beyond the subset."""
    line = getattr(node, "lineno", None)
    return NotImplementedError(f"{type(node).__name__} in line {line}")
