"""Figures drawn from results, with their source inside the file.

Each PNG file carries a hash of the results that it shows. A figure is
redrawn only if that differs.
"""

from collections.abc import Callable
from dataclasses import dataclass
from hashlib import sha256
from json import dumps
from pathlib import Path

import numpy as np
from PIL import Image
from PIL.PngImagePlugin import PngInfo

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


def draw_duel(store: Store, file: Path) -> None:
    """Draw the duel of the README from its stored trajectories."""
    from stepaside.games.game_settings import duel
    from stepaside.games.run_archive import read_record
    from stepaside.report.run_figure import draw_run

    result = store.result("duel-seed7")
    with np.load(store.folder / result["trajectories"]["file"]) as arrays:
        tracks = {name: arrays[name] for name in arrays.files}
    settings = duel(seed=result["settings"]["seed"])
    run = read_record("duel-seed7", settings, result["summary"], tracks)
    draw_run(run, file)


PICTURES = {"duel.png": Picture(("duel-seed7",), draw_duel)}


def drawn_from(file: Path) -> str:
    """Return the source stored in a figure; empty if there is none."""
    with Image.open(file) as image:
        return str(image.info.get(FIELD, ""))


def draw_picture(name: str, store: Store, folder: Path = IMAGES) -> bool:
    """Draw a figure of ``PICTURES``; return False if it is up to date."""
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
