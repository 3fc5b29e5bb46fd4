"""What decides the games of a tournament."""

import json
from dataclasses import asdict, dataclass, field
from hashlib import sha256
from math import pi
from typing import Any

from ..arena import Room, RoomRecipe, draw_starts, make_room, room_entries
from ..core.errors import ConfigurationError, check_within
from ..core.poses import Pose
from ..strategies.step_game import StepGame

ERROR = ConfigurationError
HUMANOIDS = "physics"
LEVELS = ("steps", "unicycles", HUMANOIDS)
MAPS = ("given", "seen", "none")
ROOMS = (
    "studies/tournament_campaign",
)  # modules that play a game and record it
BLOCK = 10  # games that a process is given at once


@dataclass(frozen=True)
class TournamentSettings:
    """What decides a game of a tournament but its seed and its players.

    Attributes:
        level: "steps", "unicycles", which decide eight times a step, or
            "physics", in which humanoids walk, fall and touch.
        room: What the seeds make rooms of, or one room for all of them.
        game: Rules. In physics only the duration counts, of a clock that
            passes as for humanoids.
        angle: Strategy alpha of the evader "alpha", in [rad].
        map: What humanoids know of the room: "given", "seen", "none".
    """

    level: str = "steps"
    room: RoomRecipe | Room = field(default_factory=RoomRecipe)
    game: StepGame = field(default_factory=StepGame)
    angle: float = pi / 4
    map: str = "given"

    def __post_init__(self) -> None:
        """Refuse other levels and angles."""
        if self.level not in LEVELS:
            raise ERROR(
                f"level must be one of {', '.join(LEVELS)}, "
                f"got {self.level!r:.40}"
            )
        if self.map not in MAPS:
            raise ERROR(
                f"map must be one of {', '.join(MAPS)}, got {self.map!r:.40}"
            )
        if self.map != "given" and self.level != HUMANOIDS:
            raise ERROR(
                f"map must be 'given' at level {self.level}, got {self.map!r}"
            )
        moving = isinstance(self.room, Room) and self.room.moving
        if moving and self.level != HUMANOIDS:
            raise ERROR(
                f"level must be {HUMANOIDS!r} in a room in which boxes "
                f"move, got {self.level!r}"
            )
        check_within(self.angle, 0.0, pi, "angle", "rad", ERROR)

    def arena(self, seed: int) -> tuple[Room, tuple[Pose, Pose]]:
        """Room of a seed, and where both start in it."""
        if isinstance(self.room, Room):
            room = self.room
            return room, room.starts or draw_starts(room, seed)
        room = make_room(self.room, seed)
        assert room.starts is not None
        return room, room.starts

    def entries(self) -> dict[str, Any]:
        """All of it, as an object for other programs."""
        room = self.room
        physics = {"map": self.map} if self.level == HUMANOIDS else {}
        return {
            "level": self.level,
            "room": room_entries(room)
            if isinstance(room, Room)
            else asdict(room),
            "game": asdict(self.game),
            "angle_rad": self.angle,
        } | physics

    @property
    def depends(self) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Rooms of the code and libraries that its games depend on."""
        if self.level == HUMANOIDS:
            return ROOMS, ("mujoco", "numba", "numpy")
        return ROOMS, ("numba", "numpy")

    @property
    def block(self) -> int:
        """Games that a process is given at once."""
        return 1 if self.level == HUMANOIDS else BLOCK

    def fingerprint(self) -> str:
        """Digits that change with any of it."""
        text = json.dumps(self.entries(), sort_keys=True)
        return sha256(text.encode()).hexdigest()[:12]
