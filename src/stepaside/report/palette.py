"""Colours of pages and figures in the light and the dark theme."""

from collections.abc import Iterable, Mapping
from itertools import cycle
from typing import NamedTuple

from ..core.player_identity import PlayerIdentity, Rgb, Role, shades_of


class Palette(NamedTuple):
    """Colours of one theme, as ``#rrggbb``."""

    paper: str  # background of text
    ink: str  # text
    soft: str  # secondary text
    grid: str
    sky: str  # background of the scene
    floor: str  # one half of the floor's tiles
    tile: str  # the other half
    pursuer: str
    evader: str
    others: tuple[str, ...]  # further players, in this order
    pushed: str
    theory: str
    mean: str  # means over a gait cycle
    sway: str  # the same quantities at every sample
    support: str  # support polygons


# Red and blue differ in brightness, too, for readers with colour blindness.
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


def rgb(colour: str) -> tuple[int, int, int]:
    """Return red, green and blue, 0 to 255, of a colour ``#rrggbb``."""
    red, green, blue = bytes.fromhex(colour[1:])
    return red, green, blue


def fractions(colour: str) -> Rgb:
    """Return red, green and blue, 0 to 1, of a colour ``#rrggbb``."""
    red, green, blue = (part / 255.0 for part in rgb(colour))
    return red, green, blue


def markers_of(names: Iterable[str]) -> dict[str, str]:
    """Return a marker of Matplotlib for each player, by name."""
    return dict(zip(names, cycle("os^DvPX*<>"), strict=False))


def colours_in(
    theme: str,
    players: Iterable[str],
    identities: Mapping[str, PlayerIdentity],
) -> dict[str, str]:
    """Return the colour of each player: its role's, or the next free one.

    Players of one role have shades of its colour.
    """
    palette = PALETTES[theme]
    base = {
        Role.PURSUER: fractions(palette.pursuer),
        Role.EVADER: fractions(palette.evader),
        Role.BYSTANDER: fractions(palette.soft),
    }
    shades = shades_of(identities, base)
    roles = {"pursuer": palette.pursuer, "evader": palette.evader}
    others = cycle(palette.others)
    return {
        name: "#" + bytes(round(255.0 * x) for x in shades[name]).hex()
        if name in shades
        else roles.get(name) or next(others)
        for name in players
    }
