"""All faults of a module, and random samples of them."""

import ast
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from hashlib import sha256
from itertools import islice
from pathlib import Path

from .operators import edits_of_expression, edits_of_statement
from .places import Place, walk
from .source import Edit, Source


@dataclass(frozen=True, slots=True)
class Fault:
    """Change of one file.

    Attributes:
        key: Identifier that does not depend on other code.
        file: Path from the root of the tree.
        line: Line of the change, from one.
        lines: First and last line of the statement.
        scope: Dotted name of the enclosing class or function.
        names: Names that carry the effect of a fault at import.
        operator: Kind of fault.
        before: Changed lines, before.
        after: Changed lines, after.
        edit: Edit of the source.
    """

    key: str
    file: str
    line: int
    lines: tuple[int, int]
    scope: str
    names: tuple[str, ...]
    operator: str
    before: str
    after: str
    edit: Edit


def faults_of(
    file: str, text: str, optional: dict[str, set[str]], seed: int
) -> Iterator[Fault]:
    """Return one fault for each node that can have one.

    Args:
        file: Path from the root of the tree.
        text: Text of the module.
        optional: Output of :func:`.places.optional_keywords`.
        seed: Seed of the choice among the faults of a node.
    """
    source = Source(text)
    seen: dict[str, int] = {}
    for place, node in walk(source.tree, Place()):
        if isinstance(node, ast.expr):
            edits = edits_of_expression(source, node, optional)
        else:
            edits = edits_of_statement(source, node, place.returns)
        found = []
        for edit in edits:
            if edit is not None:
                before, after = source.lines_around(edit)
                scope = ".".join(place.scope)
                name = f"{file}:{scope}: {before} => {after}"
                seen[name] = seen.get(name, 0) + 1
                key = name if seen[name] == 1 else f"{name} #{seen[name]}"
                found.append(
                    Fault(
                        key,
                        file,
                        source.line(edit.start),
                        place.lines,
                        scope,
                        place.names,
                        edit.operator,
                        before,
                        after,
                        edit,
                    )
                )
        if found:
            yield min(found, key=lambda fault: _lot(seed, fault.key))


def draw(
    faults: Iterable[Fault],
    texts: Mapping[str, str],
    count: int | None,
    seed: int,
) -> list[Fault]:
    """Draw faults without replacement; a small sample is part of a larger one.

    The random number of a fault depends on its own text only, so that a fault
    remains in the sample when other code changes.

    Args:
        faults: Faults to draw from.
        texts: Text of each file.
        count: Size of the sample; None for all.
        seed: Random seed.
    """
    lots = sorted(faults, key=lambda fault: _lot(seed, f"draw {fault.key}"))
    changes = (fault for fault in lots if _is_change(texts[fault.file], fault))
    return list(islice(changes, count))


def modules_of(root: Path, parts: Iterable[str]) -> list[str]:
    """Return the Python files among files and below folders of a tree."""
    found: list[str] = []
    for part in parts:
        path = root / part
        files = [path] if path.is_file() else sorted(path.rglob("*.py"))
        if not files:
            raise FileNotFoundError(f"no Python file at {part!r}")
        found += [file.relative_to(root).as_posix() for file in files]
    return found


def _lot(seed: int, name: str) -> bytes:
    return sha256(f"{seed} {name}".encode()).digest()


def _is_change(text: str, fault: Fault) -> bool:
    source = Source(text)
    try:
        changed = ast.parse(source.apply(fault.edit))
    except SyntaxError:
        return False
    return ast.dump(changed) != ast.dump(source.tree)
