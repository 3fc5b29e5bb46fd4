"""Figures drawn from results, with their source inside the file.

Each PNG file carries a hash of the results that it shows. A figure is
redrawn only if that differs.
"""

from collections.abc import Callable
from dataclasses import dataclass
from hashlib import sha256
from json import dumps
from pathlib import Path

from PIL import Image
from PIL.PngImagePlugin import PngInfo

from . import drawings
from .store import ROOT, Store

IMAGES = ROOT / "docs" / "images"
FIELD = "Source"  # a text that PNG knows by this name


@dataclass(frozen=True, slots=True)
class Picture:
    """Figure of results.

    Attributes:
        results: Names of the results.
        draw: Draws results of the store into a file.
    """

    results: tuple[str, ...]
    draw: Callable[[Store, Path], None]

    def source(self, store: Store) -> str:
        """Return the names and the hash of the results."""
        digest = sha256()
        for name in self.results:
            digest.update(dumps(store.result(name), sort_keys=True).encode())
        names = ", ".join(f"{name}.json" for name in self.results)
        return f"{names} {digest.hexdigest()[:12]}"


PICTURES = {
    "duel.png": Picture(("duel-seed7",), drawings.duel),
    "duels.png": Picture(
        ("duels-ideal", "duels-hardware", "duels-cameras"),
        drawings.many_duels,
    ),
    "people.png": Picture(("people-ideal",), drawings.people),
    "push-limits.png": Picture(("pushes",), drawings.push_limits),
    "survival-hardware.png": Picture(
        ("survival-hardware",), drawings.survival_on_hardware
    ),
}


def drawn_from(file: Path) -> str:
    """Return the source stored in a figure; empty if there is none."""
    with Image.open(file) as image:
        return str(image.info.get(FIELD, ""))


def draw_picture(name: str, store: Store, folder: Path = IMAGES) -> bool:
    """Draw a figure unless it is up to date.

    Args:
        name: Key of ``PICTURES``.
        store: Results.
        folder: Folder of the figures.

    Returns:
        Whether it was drawn.
    """
    picture, file = PICTURES[name], folder / name
    source = picture.source(store)
    if file.exists() and drawn_from(file) == source:
        return False
    draft = file.with_name(f".draft-{name}")
    try:
        picture.draw(store, draft)
        info = PngInfo()
        info.add_text(FIELD, source)
        with Image.open(draft) as image:
            image.load()
            image.save(draft, pnginfo=info, optimize=True)
        draft.replace(file)
    finally:
        draft.unlink(missing_ok=True)
    return True
