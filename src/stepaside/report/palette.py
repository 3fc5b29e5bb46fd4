"""Colours of pages by day and by night, of words and of what is drawn."""

from collections.abc import Iterable
from itertools import cycle
from typing import NamedTuple

LIGHTS = ("light", "dark")


class Palette(NamedTuple):
    """Colours of one light, as ``#rrggbb``.

    Attributes:
        paper: Behind words.
        ink: Of words.
        soft: Of words that stand back.
        grid: Of lines that only part.
        sky: Behind the robots.
        floor: Of one half of the floor's tiles.
        tile: Of the other half.
        pursuer: The role's own.
        evader: Likewise.
        others: Of players who have no role, one after the other.
        pushed: Of pushes.
        theory: Of all that theory says.
        mean: Of what both players make together.
        sway: Of the same with every step in it.
        support: Of support polygons.
    """

    paper: str
    ink: str
    soft: str
    grid: str
    sky: str
    floor: str
    tile: str
    pursuer: str
    evader: str
    others: tuple[str, ...]
    pushed: str
    theory: str
    mean: str
    sway: str
    support: str


# Red and blue that differ in brightness, too, for who sees no red.
PALETTES = {
    "light": Palette(
        paper="#fbfbf9",
        ink="#1d1f21",
        soft="#5c6166",
        grid="#dcdcd6",
        sky="#eef1f4",
        floor="#dedcd6",
        tile="#cdcbc4",
        pursuer="#b92b19",
        evader="#1f5fbf",
        others=("#0b6a5d", "#8f4f14", "#6a3d9a", "#6f5600", "#a8236b"),
        pushed="#a3005f",
        theory="#444444",
        mean="#5b2a86",
        sway="#b9a5cf",
        support="#1c7a42",
    ),
    "dark": Palette(
        paper="#15181b",
        ink="#ececea",
        soft="#a6abb0",
        grid="#33383d",
        sky="#101316",
        floor="#262a2e",
        tile="#2c3136",
        pursuer="#ff8a73",
        evader="#7fb2ff",
        others=("#52cdbb", "#eaa86b", "#c6a4ee", "#d8c05c", "#f491c3"),
        pushed="#ff8fce",
        theory="#c9c9c4",
        mean="#d9b8fa",
        sway="#77618c",
        support="#67cf93",
    ),
}


class FloorColour(NamedTuple):
    """Floor of a page that is served.

    Attributes:
        ground: Its colour.
        line: Of its grid.
        shadow: How dark shadows are, from 0 to 1.
    """

    ground: str
    line: str
    shadow: float


FLOORS = {
    "light": FloorColour("#f0efec", "#dad9d4", 0.30),
    "dark": FloorColour("#1b1e21", "#32373c", 0.55),
}
# What is drawn for all viewers at once is seen on both floors.
FOR_BOTH = {
    "#1f5fbf": "#2c6fd6",
    "#444444": "#767676",
    "#2a9d55": "#23894a",
    "#e8a598": "#d06a55",
    "#9bb8e8": "#5b8ad8",
    "#b5006b": "#cf2a86",
}


def seen_by_all(colour: str) -> str:
    """Colour that is seen on both floors, for one of figures."""
    return FOR_BOTH.get(colour, colour)


def colours_in(light: str, players: Iterable[str]) -> dict[str, str]:
    """Colour of each player: of its role, or one that nobody else has.

    Args:
        light: One of ``LIGHTS``.
        players: Their names.
    """
    here = PALETTES[light]
    own = {"pursuer": here.pursuer, "evader": here.evader}
    others = cycle(here.others)
    return {name: own.get(name) or next(others) for name in players}


def contrast(one: str, other: str) -> float:
    """Contrast of two colours, from 1 to 21.

    Args:
        one: As ``#rrggbb``.
        other: Likewise.

    Returns:
        Ratio of relative luminances, as WCAG 2.2 defines it.
    """
    dim, bright = sorted((_luminance(one), _luminance(other)))
    return (bright + 0.05) / (dim + 0.05)


def _luminance(colour: str) -> float:
    parts = [part / 255.0 for part in bytes.fromhex(colour[1:])]
    red, green, blue = (
        c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4
        for c in parts
    )
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue
