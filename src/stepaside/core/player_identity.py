"""Identity of a player: name, role and team, and shades of its colour."""

from collections.abc import Mapping
from enum import StrEnum
from typing import NamedTuple


class Role(StrEnum):
    """Role of a player in a game."""

    PURSUER = "pursuer"
    EVADER = "evader"
    BYSTANDER = "bystander"

    def opposes(self, other: "Role") -> bool:
        """Return whether two roles are those of opponents."""
        return {self, other} == {Role.PURSUER, Role.EVADER}


class PlayerIdentity(NamedTuple):
    """Name of a player, unique in its game, with its role and team."""

    name: str
    role: Role
    team: str

    def opposes(self, other: "PlayerIdentity") -> bool:
        """Return whether two players are opponents: by role, not by team."""
        return self.role.opposes(other.role)

    def is_with(self, other: "PlayerIdentity") -> bool:
        """Return whether another player is a teammate."""
        return self.team == other.team and self.name != other.name


# Mixed with white (positive) or black (negative), in the order of players of
# one role, who thus differ in brightness.
MIXES = (0.0, 0.38, -0.38, 0.6, -0.6, 0.2, -0.2, 0.5)
Rgb = tuple[float, float, float]
Colour = tuple[float, float, float, float]  # red, green, blue, opacity


def shades_of(
    identities: Mapping[str, PlayerIdentity], base: Mapping[Role, Rgb]
) -> dict[str, Rgb]:
    """Return the colour of each player: a shade of its role's."""
    counts = dict.fromkeys(Role, 0)
    found = {}
    for name, identity in identities.items():
        mix = MIXES[counts[identity.role] % len(MIXES)]
        counts[identity.role] += 1
        end = 1.0 if mix > 0.0 else 0.0
        red, green, blue = (
            c + abs(mix) * (end - c) for c in base[identity.role]
        )
        found[name] = red, green, blue
    return found
