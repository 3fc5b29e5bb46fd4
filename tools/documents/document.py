"""A document: what is made in it, as it is and as it should be."""

from pathlib import Path

from .blocks import block_parts
from .numbers import number_parts
from .parts import Part
from .store import ROOT, Store


def documents() -> list[Path]:
    """README and all pages of docs/ but the ones that studies write."""
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md")]
    return sorted([*pages, ROOT / "docs" / "results" / "README.md"])


def parts_of(text: str, store: Store) -> list[Part]:
    """Everything in a text that is made, in its order.

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
    """Text with everything as it should be; what is unknown stays."""
    for part in reversed(parts_of(text, store)):
        if part.wanted is not None:
            end = part.start + len(part.got)
            text = text[: part.start] + part.wanted + text[end:]
    return text


def complaints(file: Path, store: Store) -> list[str]:
    """What of a document is not as the results have it.

    Returns:
        Messages with document, line, wanted and got.
    """
    text = file.read_text(encoding="utf-8")
    name = file.relative_to(ROOT) if file.is_relative_to(ROOT) else file.name
    return [
        f"{name}:{complaint}"
        for part in parts_of(text, store)
        for complaint in part.complaints(text)
    ]
