"""Identity of a player: name, role and team."""

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
