"""Tests that a fault can affect, including code that is not traced."""

import ast
from collections.abc import Iterable, Mapping
from pathlib import Path

from .faults import Fault
from .imports import Imports
from .places import Place, walk
from .reach import Reach

# Decorators of functions whose lines are not traced on every call.
HIDDEN = (
    *("compiled", "compiled_parallel", "inlined", "shared"),
    *("cache", "cached_property", "lru_cache"),
)


class Index:
    """Index from lines to tests, by name where lines are not traced.

    Constants and defaults act wherever their name is read. So do compiled
    functions, whose lines are never traced, and cached ones, whose lines are
    traced only once.

    Args:
        root: Tree with the package and its tests.
        reaches: What the tests of each file reach.
    """

    def __init__(self, root: Path, reaches: Mapping[str, Reach]) -> None:
        self.times = {
            test: time
            for reach in reaches.values()
            for test, time in reach.times.items()
        }
        self._lines: dict[tuple[str, int], set[str]] = {}
        for reach in reaches.values():
            for file, lines in reach.lines.items():
                for line, tests in lines.items():
                    self._lines.setdefault((file, line), set()).update(tests)
        self._places: dict[str, list[tuple[str, Place]]] = {}
        self._by_file: dict[str, set[str]] = {}
        self._imports: dict[str, set[str]] = {}
        self._hidden: set[str] = set()
        self._found: dict[str, set[str]] = {}
        for path in sorted((root / "src").rglob("*.py")):
            self._read(path.relative_to(root).as_posix(), path)
        for file, reach in reaches.items():
            self._read_tests(root / file, set(reach.times))
        self._near = Imports(root, reaches)
        self._of_file = {f: set(reach.times) for f, reach in reaches.items()}

    def tests(self, fault: Fault) -> set[str]:
        """Return the tests that a fault can affect."""
        return self._tests(fault.file, fault.scope, fault.lines, fault.names)

    def near(self, fault: Fault) -> set[str]:
        """Return the tests of files that import the module of a fault."""
        files = self._near.of(fault.file)
        return set().union(*(self._of_file[file] for file in files))

    def _tests(
        self,
        file: str,
        scope: str,
        lines: tuple[int, int],
        names: Iterable[str],
    ) -> set[str]:
        found = self._traced(file, lines)
        inner = scope.rpartition(".")[2]
        for name in {*names, *({inner} & self._hidden)}:
            found |= self._of_name(name)
        if not found:
            module = Path(file).stem
            found = found | self._imports.get(module, set())
        return found

    def _traced(self, file: str, lines: tuple[int, int]) -> set[str]:
        first, last = lines
        return set().union(
            *(
                self._lines.get((file, line), set())
                for line in range(first, last + 1)
            )
        )

    def _of_name(self, name: str) -> set[str]:
        """Return the tests that read a name, or reach a line that does."""
        if name not in self._found:
            self._found[name] = set()  # breaks cycles
            found = set(self._by_file.get(name, set()))
            for file, place in self._places.get(name, []):
                found |= self._traced(file, place.lines)
                inner = place.scope[-1] if place.scope else ""
                around = () if place.inside else place.names
                for other in {*around, *({inner} & self._hidden)} - {name}:
                    found |= self._of_name(other)
            self._found[name] = found
        return self._found[name]

    def _read(self, file: str, path: Path) -> None:
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef):
                called = {_called(item) for item in node.decorator_list}
                if called & set(HIDDEN):
                    self._hidden.add(node.name)
            elif isinstance(node, ast.Call) and _called(node) in HIDDEN:
                self._hidden.update(_called(arg) for arg in node.args)
        for place, node in walk(tree, Place()):
            for name in _names(node):
                self._places.setdefault(name, []).append((file, place))

    def _read_tests(self, path: Path, tests: set[str]) -> None:
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            for name in _names(node):
                self._by_file.setdefault(name, set()).update(tests)
            if isinstance(node, ast.ImportFrom | ast.Import):
                names = [alias.name for alias in node.names]
                names.append(getattr(node, "module", "") or "")
                for name in names:
                    module = name.rpartition(".")[2]
                    self._imports.setdefault(module, set()).update(tests)


def _called(node: ast.expr) -> str:
    if isinstance(node, ast.Call):
        return _called(node.func)
    if isinstance(node, ast.Attribute):
        return node.attr
    return node.id if isinstance(node, ast.Name) else ""


def _names(node: ast.AST) -> list[str]:
    match node:
        case ast.Name(id=name, ctx=ast.Load()) | ast.Attribute(attr=name):
            return [name]
        case ast.Call(keywords=keywords):
            return [word.arg for word in keywords if word.arg]
    return []
