"""Options of rooms: how large, and what stands in them."""

from pathlib import Path
from typing import Any

import click

from .declaration import OptionDeclaration
from .value_kinds import SizeType

COUNT = click.IntRange(0, 500)
SIZE = OptionDeclaration(
    "--size", "Of the floor [m], or open for no walls.", kind=SizeType()
)
DISCS = OptionDeclaration("--discs", "Discs in a room.", kind=COUNT)
BOXES = OptionDeclaration("--boxes", "Boxes in a room.", kind=COUNT)
POLYGONS = OptionDeclaration(
    "--polygons", "Polygons of three to six corners in a room.", kind=COUNT
)


class ArenaType(click.ParamType[Any]):
    """A size like 3x3, ``open``, or a file of a room."""

    name = "room"

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        """How it is written."""
        return "[WIDTHxDEPTH|open|FILE]"

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> Any:
        """Take a file for its path, and anything else for a size."""
        file = Path(str(value))
        if file.suffix.lower() in (".toml", ".json"):
            if not file.is_file():
                self.fail(f"must be a file that exists, got {value!r:.80}")
            return file
        return SizeType().convert(value, param, ctx)
