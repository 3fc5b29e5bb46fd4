"""Shades of the colours of roles, for games of many players.

Pursuers are shades of red, evaders shades of blue, bystanders grey. Players
of one role differ in brightness, and in figures also by markers.
"""

from collections.abc import Mapping
from itertools import cycle

from .player_identity import PlayerIdentity, Role

# Mixed with white (positive) or black (negative), in the order of players.
MIXES = (0.0, 0.38, -0.38, 0.6, -0.6, 0.2, -0.2, 0.5)
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*", "<", ">")
Rgb = tuple[float, float, float]
Colour = tuple[float, float, float, float]  # red, green, blue, opacity


def shade(colour: Rgb, number: int) -> Rgb:
    """Return one of eight shades of a colour; 0 is the colour itself."""
    mix = MIXES[number % len(MIXES)]
    end = 1.0 if mix > 0.0 else 0.0
    red, green, blue = (c + abs(mix) * (end - c) for c in colour)
    return red, green, blue


def shades_of(
    identities: Mapping[str, PlayerIdentity], base: Mapping[Role, Rgb]
) -> dict[str, Rgb]:
    """Return the colour of each player: a shade of its role's."""
    counts = dict.fromkeys(Role, 0)
    found = {}
    for name, identity in identities.items():
        found[name] = shade(base[identity.role], counts[identity.role])
        counts[identity.role] += 1
    return found


def markers_of(names: Mapping[str, object]) -> dict[str, str]:
    """Return a marker of Matplotlib for each player, by name."""
    return dict(zip(names, cycle(MARKERS), strict=False))


def from_hex(colour: str) -> Rgb:
    """Return red, green and blue, 0 to 1, of a colour ``#rrggbb``."""
    red, green, blue = (part / 255.0 for part in bytes.fromhex(colour[1:]))
    return red, green, blue


def to_hex(colour: Rgb) -> str:
    """Return a colour as ``#rrggbb``."""
    return "#" + "".join(f"{round(255.0 * part):02x}" for part in colour)
