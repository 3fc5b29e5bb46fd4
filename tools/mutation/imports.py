"""Index of files by the modules that they import."""

import ast
from collections.abc import Iterable, Iterator
from pathlib import Path


class Imports:
    """Imports of some files.

    Args:
        root: Tree with the package and the files.
        files: Files relative to the tree.
    """

    def __init__(self, root: Path, files: Iterable[str]) -> None:
        self._root = root
        self._names = {
            file: set(_imported(_tree(root / file))) for file in files
        }

    def of(self, module: str) -> set[str]:
        """Return files that import a module, or its names from the package.

        Args:
            module: File below ``src/``, relative to the tree.
        """
        parts = Path(module).relative_to("src").with_suffix("").parts
        if parts[-1] == "__init__":
            parts = parts[:-1]
        package = ".".join(parts[:-1])
        wanted = {".".join(parts)} | {
            f"{package}.{name}"
            for name in _defined(_tree(self._root / module))
        }
        return {file for file, names in self._names.items() if names & wanted}


def _tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def _imported(tree: ast.Module) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def _defined(tree: ast.Module) -> Iterator[str]:
    """Return the functions, classes and constants of a module."""
    for node in tree.body:
        match node:
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
                yield name
            case ast.Assign(targets=[ast.Name(id=name)]):
                yield name
            case ast.AnnAssign(target=ast.Name(id=name)):
                yield name
