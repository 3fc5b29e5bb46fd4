"""Options of rooms: how large, and what stands in them."""

import click

from .kinds import SizeType
from .option import Declaration

COUNT = click.IntRange(0, 500)
SIZE = Declaration(
    "--size", "Of the floor [m], or open for no walls.", kind=SizeType()
)
DISCS = Declaration("--discs", "Discs in a room.", kind=COUNT)
BOXES = Declaration("--boxes", "Boxes in a room.", kind=COUNT)
POLYGONS = Declaration(
    "--polygons", "Polygons of three to six corners in a room.", kind=COUNT
)
