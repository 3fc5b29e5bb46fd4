"""Nodes of a syntax tree that can be mutated."""

import ast
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

# These are text for users, not behaviour.
UNTOUCHED = ("__repr__", "__str__", "__all__")


@dataclass(frozen=True, slots=True)
class Place:
    """Context of a node.

    Attributes:
        scope: Names of the enclosing classes and functions.
        lines: First and last line of the statement.
        names: Names that a statement at import level binds.
        returns: Return annotation of the enclosing function.
        inside: Whether the node is inside a function.
    """

    scope: tuple[str, ...] = ()
    lines: tuple[int, int] = (1, 1)
    names: tuple[str, ...] = ()
    returns: str = ""
    inside: bool = False


def optional_keywords(trees: Iterable[ast.AST]) -> dict[str, set[str]]:
    """Return the keywords with a default, by name of function or class."""
    found: dict[str, set[str]] = {}
    for tree in trees:
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef):
                args = node.args
                names = found.setdefault(node.name, set())
                named = [*args.posonlyargs, *args.args]
                names.update(
                    arg.arg for arg in named[len(named) - len(args.defaults) :]
                )
                names.update(
                    arg.arg
                    for arg, default in zip(
                        args.kwonlyargs, args.kw_defaults, strict=True
                    )
                    if default is not None
                )
            elif isinstance(node, ast.ClassDef):
                found.setdefault(node.name, set()).update(
                    field.target.id
                    for field in node.body
                    if isinstance(field, ast.AnnAssign)
                    and isinstance(field.target, ast.Name)
                    and field.value is not None
                )
    return found


def walk(
    node: ast.AST, place: Place
) -> Iterator[tuple[Place, ast.expr | ast.stmt]]:
    """Yield the nodes that can be mutated, with their context."""
    match node:
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
            if name in UNTOUCHED:
                return
            yield from _walk_definition(node, place)
            return
        case ast.Import() | ast.ImportFrom() | ast.Assert() | ast.JoinedStr():
            return
        case ast.Expr(value=ast.Constant()):
            return
        case ast.If(test=ast.Name(id="TYPE_CHECKING")):
            return
        case ast.Raise():
            if place.inside:
                yield _at(node, place), node
            return
        case ast.stmt():
            place = _at(node, place)
            if any(name in UNTOUCHED for name in place.names):
                return
            if place.inside:
                yield place, node
        case ast.expr():
            yield place, node
    for field, value in ast.iter_fields(node):
        if field in ("annotation", "returns", "decorator_list"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST):
                yield from walk(child, place)


def _walk_definition(
    node: ast.FunctionDef | ast.ClassDef, place: Place
) -> Iterator[tuple[Place, ast.expr | ast.stmt]]:
    scope = (*place.scope, node.name)
    if isinstance(node, ast.ClassDef):
        within = Place(scope, names=(node.name,))
        for child in node.body:
            yield from walk(child, within)
        return
    last = node.end_lineno or node.lineno
    for default in (*node.args.defaults, *node.args.kw_defaults):
        if default is not None:
            names = (node.name,)
            whole = Place(scope, (node.body[0].lineno, last), names)
            yield from walk(default, whole)
    returns = ast.unparse(node.returns) if node.returns else ""
    within = Place(scope, returns=returns, inside=True)
    for child in node.body:
        yield from walk(child, within)


def _at(node: ast.stmt, place: Place) -> Place:
    """Return the context of a statement: its own lines, without its body."""
    last = node.end_lineno or node.lineno
    body = getattr(node, "body", None)
    if isinstance(body, list) and body:
        last = max(node.lineno, body[0].lineno - 1)
    names = place.names
    if not place.inside:
        targets = getattr(node, "targets", [getattr(node, "target", None)])
        own = [
            name.id
            for target in targets
            if target is not None
            for name in ast.walk(target)
            if isinstance(name, ast.Name)
        ]
        names = tuple(own) or names
    return Place(
        place.scope, (node.lineno, last), names, place.returns, place.inside
    )
