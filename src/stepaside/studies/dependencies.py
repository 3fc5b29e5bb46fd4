"""Files of the package that a module depends on, found from its imports.

The source is parsed, not run. Imports inside functions count like those at
the top of a file; imports for type checkers alone do not, except where a
package resolves its public names from them when they are first used.
"""

import ast
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

PACKAGE = __name__.split(".")[0]
INIT = "__init__.py"
Import = tuple[str, str | None]  # module in the package, and a name in it
Binding = tuple[str, Import]  # name in the importing file


def dependencies(root: Path, names: Iterable[str]) -> frozenset[Path]:
    """Return the files that modules or folders depend on, including their own.

    Data files belong to the modules of the package that contains them.

    Args:
        root: Folder of the package.
        names: Modules or folders, as paths below ``root`` without suffix.

    Raises:
        FileNotFoundError: If there is no such module or folder.
    """
    graph = _Graph(root)
    for name in names:
        graph.add_root(name)
    return frozenset(graph.files | graph.data())


class _Graph:
    """Import graph of a package, followed from some of its modules.

    Attributes:
        root: Folder of the package.
        files: Python files that were reached.
    """

    def __init__(self, root: Path) -> None:
        self.root = root
        self.files: set[Path] = set()
        self._folders: set[Path] = set()

    def add_root(self, name: str) -> None:
        """Follow the imports of a module, or of all modules of a folder."""
        folder, module = self.root / name, self.root / f"{name}.py"
        found = [module] if module.is_file() else []
        if folder.is_dir():
            self._folders.add(folder)
            found += sorted(folder.rglob("*.py"))
        if not found and not folder.is_dir():
            raise FileNotFoundError(
                f"no module or folder {name!r} in {self.root}"
            )
        self._follow(found)

    def data(self) -> set[Path]:
        """Return the data files of the packages that were reached."""
        own = {file.parent for file in self.files if file.name != INIT}
        found = {file for folder in own for file in self._data_in(folder)}
        for folder in self._folders:
            found |= {
                file
                for file in folder.rglob("*")
                if file.is_file() and not _is_code(file)
            }
        return found

    def _data_in(self, folder: Path) -> Iterator[Path]:
        """Yield the data files of a package without its subpackages."""
        for file in folder.iterdir():
            if file.is_dir():
                if file.name != "__pycache__" and not (file / INIT).is_file():
                    yield from self._data_in(file)
            elif not _is_code(file):
                yield file

    def _follow(self, files: Iterable[Path]) -> None:
        left = list(files)
        while left:
            file = left.pop()
            if file in self.files:
                continue
            self.files.add(file)
            left += self._packages_of(file)
            for _, (module, name) in self._imports(file):
                left += self._resolve(module, name)

    def _packages_of(self, file: Path) -> list[Path]:
        """Return the ``__init__`` files of the packages around a file."""
        around = file.relative_to(self.root).parents
        files = [self.root / folder / INIT for folder in around]
        return [each for each in files if each.is_file()]

    def _resolve(self, module: str, name: str | None) -> list[Path]:
        """Return the files behind the import of a module or of its name."""
        file = self._file(module)
        if file is None:
            return []
        if file.name != INIT:
            return [file]
        if name in (None, "*"):  # any public name may be used through it
            return [file, *self._public(file)]
        inside = f"{module}.{name}".lstrip(".")
        if self._file(inside) is not None:
            return [file, *self._resolve(inside, None)]
        return [file, *self._public(file, name)]

    def _public(self, file: Path, name: str | None = None) -> list[Path]:
        """Return the files behind all public names of a package, or one."""
        found: list[Path] = []
        stub = file.with_suffix(".pyi")  # names that are imported lazily
        for source in (file, stub) if stub.is_file() else (file,):
            for alias, (module, own) in self._imports(source, for_types=True):
                if name in (None, alias):
                    found += self._resolve(module, own)
        return found

    def _file(self, module: str) -> Path | None:
        path = self.root.joinpath(*module.split(".")) if module else self.root
        beside = path.with_suffix(".py")
        if module and beside.is_file():
            return beside
        return path / INIT if (path / INIT).is_file() else None

    def _imports(
        self, file: Path, *, for_types: bool = False
    ) -> tuple[Binding, ...]:
        """Return the imports of the package in a file, with their names."""
        package = file.relative_to(self.root).parts[:-1]
        text = file.read_text(encoding="utf-8")
        return _parse_imports(text, package, for_types)


def _is_code(file: Path) -> bool:
    return file.suffix in (".py", ".pyi") or "__pycache__" in file.parts


@cache  # versions of several results share most of their files
def _parse_imports(
    text: str, package: tuple[str, ...], for_types: bool
) -> tuple[Binding, ...]:
    nodes = _import_nodes(ast.parse(text), for_types=for_types)
    return tuple(each for node in nodes for each in _named(node, package))


def _import_nodes(
    tree: ast.AST, *, for_types: bool
) -> Iterator[ast.Import | ast.ImportFrom]:
    """Yield the import statements at any depth.

    Args:
        tree: Syntax tree to search.
        for_types: Whether to include those under ``if TYPE_CHECKING``.
    """
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield node
        elif isinstance(node, ast.If) and _is_type_checking(node.test):
            for each in (*(node.body if for_types else ()), *node.orelse):
                wrapped = ast.Module([each], [])
                yield from _import_nodes(wrapped, for_types=for_types)
        else:
            yield from _import_nodes(node, for_types=for_types)


def _is_type_checking(test: ast.expr) -> bool:
    name = test.attr if isinstance(test, ast.Attribute) else test
    name = name.id if isinstance(name, ast.Name) else name
    return name == "TYPE_CHECKING"


def _named(
    node: ast.Import | ast.ImportFrom, package: tuple[str, ...]
) -> Iterator[Binding]:
    """Yield the names that a statement binds, with their imports."""
    if isinstance(node, ast.Import):
        for alias in node.names:
            first, _, rest = alias.name.partition(".")
            if first == PACKAGE:
                yield alias.asname or first, (rest, None)
        return
    words = node.module.split(".") if node.module else []
    if node.level:
        words = [*package[: len(package) - node.level + 1], *words]
    elif words and words[0] == PACKAGE:
        del words[0]
    else:
        return
    for alias in node.names:
        yield alias.asname or alias.name, (".".join(words), alias.name)
