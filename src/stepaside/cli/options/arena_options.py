"""Options for the size of a room and its obstacles."""

from pathlib import Path
from typing import Any

import click

from .declaration import OptionDeclaration
from .value_kinds import SizeType

COUNT = click.IntRange(0, 500)
SIZE = OptionDeclaration(
    "--size",
    "Width and depth of the room [m]; open for a floor without walls.",
    kind=SizeType(),
)
DISCS = OptionDeclaration("--discs", "Number of discs.", kind=COUNT)
BOXES = OptionDeclaration("--boxes", "Number of boxes.", kind=COUNT)
POLYGONS = OptionDeclaration(
    "--polygons",
    "Number of polygons with three to six corners.",
    kind=COUNT,
)


class ArenaType(click.ParamType[Any]):
    """Size like 3x3, ``open``, or a room file."""

    name = "room"

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        """Return the placeholder for the help."""
        return "[WIDTHxDEPTH|open|FILE]"

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> Any:
        """Return the path of a room file, else the size."""
        file = Path(str(value))
        if file.suffix.lower() in (".toml", ".json"):
            if not file.is_file():
                self.fail(f"must be an existing file, got {value!r:.80}")
            return file
        return SizeType().convert(value, param, ctx)
