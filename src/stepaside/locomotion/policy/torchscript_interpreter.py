"""Symbolic evaluation of TorchScript: from code to a graph.

The code of a network is followed once with an input that has no values. Every
operation on tensors becomes a node of the graph; conditions, loops and calls
depend on shapes and constants only, and are decided on the way.
"""

import ast
from collections.abc import Mapping
from typing import Any

from ...core.errors import PolicyError
from .tensor_graph import GraphTensor, TensorGraph
from .torchscript_archive import (
    ScriptModule,
    StoredTensor,
    TorchScriptArchive,
)
from .torchscript_operators import DECIDING, OPERATORS, PLAIN

DEEPEST = 60  # calls within calls
LONGEST = 10_000  # rounds of a loop
ROOTS = frozenset({"torch", "ops", "__torch__", "CONSTANTS"})


class _Reference(str):
    """Qualified name of a function or class."""


class _Returned(Exception):  # noqa: N818 - it carries a value, no error
    """Value of a return statement."""

    def __init__(self, value: Any) -> None:
        self.value = value


class ScriptInterpreter:
    """Interpreter of the code of one archive, without executing it.

    Attributes:
        graph: Graph of the operations so far.
    """

    def __init__(self, archive: TorchScriptArchive) -> None:
        """Begin with an empty graph.

        Args:
            archive: Modules and code.
        """
        self.graph = TensorGraph()
        self._archive = archive
        self._tensors: dict[tuple[Any, ...], GraphTensor] = {}
        self._depth = 0

    def forward(self, observation: GraphTensor) -> Any:
        """Return the result of the outermost module.

        Raises:
            PolicyError: If the code uses an operation that has no
                counterpart.
            WidthFound: If the width of the observation was not known.
        """
        return self._method(self._archive.root, "forward", [observation], {})

    def _method(
        self,
        module: ScriptModule,
        name: str,
        arguments: list[Any],
        named: Mapping[str, Any],
    ) -> Any:
        """Call a method of a module."""
        owner = self._class(module.class_name)
        for node in owner.body:
            if isinstance(node, ast.FunctionDef) and node.name == name:
                return self._call(node, [module, *arguments], named)
        raise PolicyError(f"{module.class_name} has no method {name!r}")

    def _class(self, name: str) -> ast.ClassDef:
        found = self._archive.classes.get(name)
        if not isinstance(found, ast.ClassDef):
            raise PolicyError(f"the archive has no code of {name}")
        return found

    def _call(
        self,
        function: ast.FunctionDef,
        arguments: list[Any],
        named: Mapping[str, Any],
    ) -> Any:
        """Call a function with values for its parameters."""
        if self._depth >= DEEPEST:
            raise PolicyError(f"{function.name} calls itself without end")
        parameters = [each.arg for each in function.args.args]
        defaults = function.args.defaults
        values = {
            name: self._value(node, {})
            for name, node in zip(
                parameters[len(parameters) - len(defaults) :],
                defaults,
                strict=True,
            )
        }
        values |= dict(zip(parameters, arguments, strict=False))
        values |= named
        for name in parameters:
            if name not in values:
                raise PolicyError(
                    f"{function.name} must read one observation only; it has "
                    f"a further parameter {name!r}"
                )
        self._depth += 1
        try:
            self._run(function.body, values)
        except _Returned as result:
            return result.value
        finally:
            self._depth -= 1
        return None

    def _run(self, body: list[ast.stmt], values: dict[str, Any]) -> None:
        """Follow statements."""
        for node in body:
            match node:
                case ast.Assign(targets=[target], value=value):
                    self._assign(target, self._value(value, values), values)
                case ast.AnnAssign(target=target, value=ast.expr() as value):
                    self._assign(target, self._value(value, values), values)
                case ast.Expr(value=value):
                    self._value(value, values)
                case ast.Return(value=None):
                    raise _Returned(None)
                case ast.Return(value=ast.expr() as value):
                    raise _Returned(self._value(value, values))
                case ast.If(test=test, body=chosen, orelse=other):
                    met = self._value(test, values)
                    self._run(chosen if met else other, values)
                case ast.For(target=target, iter=each, body=inner):
                    for item in self._value(each, values):
                        self._assign(target, item, values)
                        self._run(inner, values)
                case ast.Pass():
                    pass
                case _:
                    raise PolicyError(
                        f"statement {ast.unparse(node)[:60]!r} has no "
                        "counterpart in a network"
                    )

    def _assign(
        self, target: ast.expr, value: Any, values: dict[str, Any]
    ) -> None:
        """Set a variable, several, or an attribute of a module."""
        match target:
            case ast.Name(id=name):
                values[name] = value
            case ast.Tuple(elts=parts) | ast.List(elts=parts):
                for part, item in zip(parts, value, strict=True):
                    self._assign(part, item, values)
            case ast.Attribute(value=owner, attr=name):
                module = self._value(owner, values)
                present = self._attribute(module, name)
                if not isinstance(present, GraphTensor):
                    raise PolicyError(
                        f"the code changes {name!r}, which is no tensor"
                    )
                self.graph.update(present, value)
            case _:
                raise PolicyError(
                    f"assignment to {ast.unparse(target)[:60]!r} has no "
                    "counterpart in a network"
                )

    def _value(self, node: ast.expr, values: Mapping[str, Any]) -> Any:
        """Evaluate an expression."""
        match node:
            case ast.Constant(value=value):
                return value
            case ast.Name(id="inf"):
                return float("inf")
            case ast.Name(id=name) if name in values:
                return values[name]
            case ast.Tuple(elts=parts):
                return tuple(self._value(part, values) for part in parts)
            case ast.List(elts=parts):
                return [self._value(part, values) for part in parts]
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return -self._value(operand, values)
            case ast.Subscript(value=owner, slice=index):
                return self._value(owner, values)[self._value(index, values)]
            case ast.Attribute(value=owner, attr=name):
                path = _path_of(node)
                if path.startswith("CONSTANTS.c"):
                    at = int(path.removeprefix("CONSTANTS.c"))
                    return self._known(self._archive.constants[at], path)
                if path:
                    return _Reference(path)
                return self._attribute(self._value(owner, values), name)
            case ast.Call(func=function, args=arguments, keywords=keywords):
                return self._evaluate_call(
                    function, arguments, keywords, values
                )
        raise PolicyError(
            f"expression {ast.unparse(node)[:60]!r} has no counterpart in a "
            "network"
        )

    def _evaluate_call(
        self,
        function: ast.expr,
        arguments: list[ast.expr],
        keywords: list[ast.keyword],
        values: Mapping[str, Any],
    ) -> Any:
        """Evaluate a call of an operation, function or method."""
        if isinstance(function, ast.Name) and function.id not in values:
            return self._builtin(function.id, arguments, values)
        given = [self._value(each, values) for each in arguments]
        named = {
            each.arg: self._value(each.value, values)
            for each in keywords
            if each.arg is not None
        }
        if isinstance(function, ast.Attribute) and not _path_of(function):
            owner = self._value(function.value, values)
            if isinstance(owner, ScriptModule):
                return self._method(owner, function.attr, given, named)
        else:
            called = self._value(function, values)
            if isinstance(called, _Reference):
                return self._function(called, given, named)
        raise PolicyError(
            f"{ast.unparse(function)[:60]!r} is not a function of the archive"
        )

    def _builtin(
        self, name: str, arguments: list[ast.expr], values: Mapping[str, Any]
    ) -> Any:
        """Evaluate a call of a function of the language."""
        if name in ("annotate", "unchecked_cast"):  # a type, then a value
            return self._value(arguments[1], values)
        if name == "uninitialized":
            return None
        given = [self._value(each, values) for each in arguments]
        if name == "getattr":
            return self._attribute(given[0], given[1])
        known: dict[str, Any] = {
            "int": int,
            "float": float,
            "bool": bool,
            "range": _range,
        }
        if name not in known or any(
            isinstance(value, GraphTensor) for value in given
        ):
            raise PolicyError(
                f"{name}() of a tensor has no counterpart in a network"
            )
        return known[name](*given)

    def _function(
        self, path: str, given: list[Any], named: dict[str, Any]
    ) -> Any:
        """Evaluate a function of PyTorch or of the archive."""
        if path in self._archive.classes:
            called = self._archive.classes[path]
            if isinstance(called, ast.FunctionDef):
                return self._call(called, given, named)
        root, _, name = path.partition(".")
        if path == "ops.prim.RaiseException":
            raise PolicyError(str(given[0]))
        if path.startswith("ops.prim."):  # type and device of a tensor
            return None
        if root == "torch":
            tensors = any(_holds_tensor(value) for value in given)
            if name in PLAIN and not (tensors and name in DECIDING):
                return PLAIN[name](*given)
            if name in OPERATORS:
                return OPERATORS[name](self.graph, *given, **named)
            if name.endswith("_") and name[:-1] in OPERATORS:
                result = OPERATORS[name[:-1]](self.graph, *given, **named)
                return self.graph.update(given[0], result)
        raise PolicyError(f"operation {path} has no counterpart in a network")

    def _attribute(self, owner: Any, name: str) -> Any:
        """Return an attribute of a module."""
        if not isinstance(owner, ScriptModule):
            raise PolicyError(f"attribute {name!r} is not one of a module")
        if name in owner.attributes:
            return self._known(owner.attributes[name], name)
        for node in self._class(owner.class_name).body:
            match node:
                case ast.AnnAssign(
                    target=ast.Name(id=found), value=ast.expr() as value
                ) if found == name:
                    return self._value(value, {})
        raise PolicyError(f"{owner.class_name} has no attribute {name!r}")

    def _known(self, value: Any, name: str) -> Any:
        """Return a stored value, with its tensors as those of the graph."""
        if isinstance(value, StoredTensor):
            if value.key not in self._tensors:
                unique = f"{name}_{len(self._tensors)}"
                self._tensors[value.key] = self.graph.store(
                    unique, value.values
                )
            return self._tensors[value.key]
        if isinstance(value, list):
            return [self._known(each, name) for each in value]
        return value


def _range(*bounds: int) -> range:
    """Return the rounds of a loop."""
    rounds = range(*bounds)
    if len(rounds) > LONGEST:
        raise PolicyError(f"a range of {len(rounds)} is longer than {LONGEST}")
    return rounds


def _path_of(node: ast.expr) -> str:
    """Return a dotted name that begins with a root; else an empty text."""
    parts = []
    while isinstance(node, ast.Attribute):
        parts.append(node.attr)
        node = node.value
    if not isinstance(node, ast.Name) or node.id not in ROOTS:
        return ""
    return ".".join([node.id, *reversed(parts)])


def _holds_tensor(value: Any) -> bool:
    """Return whether a value is a tensor or a list with one."""
    if isinstance(value, list | tuple):
        return any(isinstance(each, GraphTensor) for each in value)
    return isinstance(value, GraphTensor)
