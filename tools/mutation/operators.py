"""Mutation operators: edits of one node of a syntax tree."""

import ast
from collections.abc import Iterator

from .signs import ARITHMETIC, EDGE, LEFT_OUT, NEGATED, SWAPPED
from .source import Edit, Source


def edits_of_expression(
    source: Source, node: ast.expr, optional: dict[str, set[str]]
) -> Iterator[Edit | None]:
    """Return the edits of an expression.

    Args:
        source: Source of its module.
        node: Expression.
        optional: Optional keywords of calls, by name of the function.
    """
    match node:
        case ast.BinOp(left=left, op=op, right=right):
            if type(op) in ARITHMETIC and not _is_text(left, right):
                sign = ARITHMETIC[type(op)]
                yield source.between("arithmetic", left, right, *sign)
            if isinstance(op, ast.Mult | ast.Div):
                yield source.replace("sign", node, f"(-({source.text(node)}))")
        case ast.Compare(left=left, ops=[op], comparators=[right]):
            sign = NEGATED[type(op)]
            yield source.between("comparison", left, right, *sign)
            if type(op) in EDGE and (_is_count(left) or _is_count(right)):
                yield source.between("edge", left, right, *EDGE[type(op)])
        case ast.Compare(left=left, ops=[op, *_], comparators=[right, *_]):
            sign = NEGATED[type(op)]
            yield source.between("comparison", left, right, *sign)
        case ast.BoolOp(op=op, values=[first, second, *_]):
            signs = ("and", "or")
            old, new = signs if isinstance(op, ast.And) else signs[::-1]
            yield source.between("boolean", first, second, old, new)
        case ast.UnaryOp(op=ast.USub() | ast.Not(), operand=operand):
            yield source.replace("sign", node, f"({source.text(operand)})")
        case ast.Constant(value=value):
            yield from _edits_of_constant(source, node, value)
        case ast.IfExp(test=test):
            text = f"(not ({source.text(test)}))"
            yield source.replace("condition", test, text)
        case ast.Call(func=function, args=args, keywords=keywords):
            yield from _edits_of_call(source, node, function, args)
            for keyword in keywords:
                if keyword.arg in optional.get(_name(function), ()):
                    yield _without(source, keyword)


def edits_of_statement(
    source: Source, node: ast.stmt, returns: str
) -> Iterator[Edit | None]:
    """Return the edits of a statement.

    Args:
        source: Source of its module.
        node: Statement.
        returns: Return annotation of the enclosing function.
    """
    match node:
        case ast.If(test=test):
            text = f"not ({source.text(test)})"
            yield source.replace("condition", test, text)
        case ast.Return(value=ast.expr() as value):
            text = source.text(value)
            if returns == "bool":
                yield source.replace("return", value, f"not ({text})")
            elif returns in ("float", "int", "Array", "NDArray[np.float64]"):
                yield source.replace("return", value, f"-({text})")
            elif returns.endswith("| None") and text != "None":
                yield source.replace("return", value, "None")
        case ast.AugAssign(op=op):
            if type(op) in ARITHMETIC:
                old, new = ARITHMETIC[type(op)]
                yield source.between(
                    "arithmetic", node.target, node.value, f"{old}=", f"{new}="
                )
            yield source.replace("removed", node, "pass")
        case ast.Assign(targets=[ast.Attribute() | ast.Subscript()]):
            yield source.replace("removed", node, "pass")
        case ast.Expr(value=ast.Call()) | ast.Raise():
            yield source.replace("removed", node, "pass")
        case ast.Break() | ast.Continue():
            other = "continue" if isinstance(node, ast.Break) else "break"
            yield source.replace("loop", node, other)


def _edits_of_constant(
    source: Source, node: ast.expr, value: object
) -> Iterator[Edit]:
    if isinstance(value, bool):
        yield source.replace("constant", node, str(not value))
    elif isinstance(value, int):
        yield source.replace("constant", node, str(value + 1))
        if value > 0:
            yield source.replace("constant", node, str(value - 1))
    elif isinstance(value, float):
        for other in (1.25 * value, 0.5 * value) if value else (1.0,):
            text = repr(float(f"{other:.6g}"))
            yield source.replace("constant", node, text)


def _edits_of_call(
    source: Source, node: ast.expr, function: ast.expr, args: list[ast.expr]
) -> Iterator[Edit]:
    name = _name(function)
    if name in LEFT_OUT and args:
        yield source.replace("left out", node, f"({source.text(args[0])})")
    if name in SWAPPED:
        start, end = source.span(function)
        yield Edit("swapped", end - len(name), end, SWAPPED[name])
    if name in ("arctan2", "atan2"):
        first, second = (source.text(arg) for arg in args[:2])
        called = source.text(function)
        yield source.replace("swapped", node, f"{called}({second}, {first})")


def _without(source: Source, keyword: ast.keyword) -> Edit | None:
    """Remove a keyword and the comma after it, or else before it."""
    start, end = source.span(keyword)
    rest = source.data[end:].lstrip()
    if rest[:1] == b",":
        end = source.data.index(b",", end) + 1
    elif rest[:1] != b")":
        return None
    return Edit("keyword", start, end, "")


def _is_text(*nodes: ast.expr) -> bool:
    return any(
        isinstance(node, ast.JoinedStr)
        or (isinstance(node, ast.Constant) and isinstance(node.value, str))
        for node in nodes
    )


def _is_count(node: ast.expr) -> bool:
    if isinstance(node, ast.Call):
        return _name(node.func) == "len"
    return isinstance(node, ast.Constant) and isinstance(
        node.value, int | float
    )


def _name(function: ast.expr) -> str:
    if isinstance(function, ast.Attribute):
        return function.attr
    return function.id if isinstance(function, ast.Name) else ""
