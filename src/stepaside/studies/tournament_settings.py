"""Settings of a tournament."""

from dataclasses import dataclass, field

from ..arena import (
    Room,
    RoomRecipe,
    draw_initial_poses,
    generate_room,
)
from ..core.errors import ConfigurationError
from ..core.poses import Pose
from ..strategies.strategy_game import StepGame

ERROR = ConfigurationError
HUMANOIDS = "physics"
LEVELS = ("steps", "unicycle", HUMANOIDS)
MAPS = ("given", "seen", "none")


@dataclass(frozen=True)
class TournamentSettings:
    """Settings of a tournament game, without its seed and players.

    Attributes:
        level: "steps"; "unicycle", with eight decisions per step; or
            "physics", with simulated humanoids.
        room: Recipe of a random room per seed, or one room for all seeds.
        game: Rules. At level "physics" only the duration is used.
        map: Map of the humanoids: "given", "seen" or "none".
    """

    level: str = "steps"
    room: RoomRecipe | Room = field(default_factory=RoomRecipe)
    game: StepGame = field(default_factory=StepGame)
    map: str = "given"

    def __post_init__(self) -> None:
        """Validate the settings."""
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
                f"level must be {HUMANOIDS!r} in a room with moving boxes, "
                f"got {self.level!r}"
            )
        ratio = self.game.pursuer_speed_ratio
        if ratio != 1.0 and self.level == HUMANOIDS:
            raise ERROR(
                "game.pursuer_speed_ratio must be 1 [1] at level "
                f"{HUMANOIDS}, got {ratio}"
            )

    def arena(self, seed: int) -> tuple[Room, tuple[Pose, Pose]]:
        """Return the room of a seed, and the initial poses in it."""
        if isinstance(self.room, Room):
            room = self.room
            return room, room.starts or draw_initial_poses(room, seed)
        room = generate_room(self.room, seed)
        assert room.starts is not None
        return room, room.starts
