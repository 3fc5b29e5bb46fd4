"""Generated parts of a document: current and expected text."""

from pathlib import Path

from .blocks import block_parts
from .numbers import number_parts
from .parts import Part
from .store import ROOT, Store


def documents() -> list[Path]:
    """Return README and all pages of docs/ that no study writes."""
    pages = [*(ROOT / "docs").glob("*.md")]
    pages += [*(ROOT / "docs" / "results").glob("*.md")]
    return sorted([ROOT / "README.md", *pages])


def parts_of(text: str, store: Store) -> list[Part]:
    """Return all generated parts of a text, in order.

    A number inside a block belongs to the block.
    """
    blocks = list(block_parts(text, store))
    numbers = [
        part
        for part in number_parts(text, store)
        if not any(
            b.start <= part.start < b.start + len(b.got) for b in blocks
        )
    ]
    return sorted([*blocks, *numbers], key=lambda part: part.start)


def remade(text: str, store: Store) -> str:
    """Return a text with all parts as expected; keep unknown parts."""
    for part in reversed(parts_of(text, store)):
        if part.wanted is not None:
            end = part.start + len(part.got)
            text = text[: part.start] + part.wanted + text[end:]
    return text


def complaints(file: Path, store: Store) -> list[str]:
    """Return messages about parts of a document that differ from the results.

    Returns:
        Messages with document, line, expected and current text.
    """
    text = file.read_text(encoding="utf-8")
    name = file.relative_to(ROOT) if file.is_relative_to(ROOT) else file.name
    return [
        f"{name}:{complaint}"
        for part in parts_of(text, store)
        for complaint in part.complaints(text)
    ]
