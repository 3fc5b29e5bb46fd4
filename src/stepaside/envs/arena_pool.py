"""Rooms and initial poses of the episodes of an environment."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..arena import (
    OPEN_FLOOR,
    Room,
    RoomRecipe,
    draw_any_start,
    draw_initial_poses,
    generate_room,
)
from ..arena.obstacles import ObstacleSet
from ..core.errors import ConfigurationError, check_within
from ..core.poses import Array, Pose
from .step_batch import RoomBatch

# Arenas between one episode and the next of the same seed: a prime that
# divides no usual number of arenas, so that all of them come.
STRIDE = 7919
MOST = 100_000


@dataclass(frozen=True, eq=False)
class ArenaPool:
    """Arenas, drawn once; an episode takes one of them.

    Arena i is that of seed i in a tournament, in the same room.

    Attributes:
        rooms: Room of each arena.
        starts: Initial poses of pursuer and evader in each.
    """

    rooms: tuple[Room, ...]
    starts: tuple[tuple[Pose, Pose], ...]

    @classmethod
    def draw(
        cls,
        room: Room | RoomRecipe | None,
        arenas: int,
        first: int = 0,
        *,
        any_heading: bool = False,
    ) -> "ArenaPool":
        """Draw arenas.

        Args:
            room: A room, a recipe for a room of each arena, or None for an
                open floor.
            arenas: Number of arenas.
            first: Seed of the first arena.
            any_heading: Whether the players begin with any headings, on an
                open floor, instead of those of a duel.

        Raises:
            ConfigurationError: If a value is out of range, or a room has no
                space.
        """
        check_within(arenas, 1, MOST, "arenas", "1", ConfigurationError)
        check_within(first, 0, 2**31, "first_arena", "1", ConfigurationError)
        if not isinstance(room, Room | RoomRecipe | None):
            raise ConfigurationError(
                f"room must be a Room, a RoomRecipe or None, got {room!r:.60}"
            )
        if any_heading and room is not None:
            raise ConfigurationError(
                "any_heading must be false in a room, got true"
            )
        seeds = range(int(first), int(first) + int(arenas))
        rooms = tuple(
            generate_room(room, seed)
            if isinstance(room, RoomRecipe)
            else room or OPEN_FLOOR
            for seed in seeds
        )
        if any(each.moving for each in rooms):
            raise ConfigurationError(
                "room must have no moving boxes at this level"
            )
        return cls(
            rooms,
            tuple(
                draw_any_start(seed)
                if any_heading
                else room.starts or draw_initial_poses(room, seed)
                for room, seed in zip(rooms, seeds, strict=True)
            ),
        )

    def __len__(self) -> int:
        """Return the number of arenas."""
        return len(self.rooms)

    def indices(
        self, seeds: ArrayLike, episodes: ArrayLike
    ) -> NDArray[np.int64]:
        """Return the arena of each episode.

        Args:
            seeds: Seed of each game. Shape (n,).
            episodes: Number of the episode since it was seeded. Shape (n,).
        """
        sums = np.asarray(seeds, dtype=np.int64) + STRIDE * np.asarray(
            episodes, dtype=np.int64
        )
        indices: NDArray[np.int64] = sums % len(self)
        return indices

    def start_rows(self) -> Array:
        """Return all starts as x, y [m], cosine and sine of the heading.

        Shape (arenas, 2, 4).
        """
        poses = np.array(self.starts, dtype=np.float64)
        heading = poses[..., 2:]
        return np.concatenate(
            [poses[..., :2], np.cos(heading), np.sin(heading)], axis=-1
        )

    def packed(self) -> RoomBatch:
        """Return the obstacles of all rooms for compiled loops."""
        solids = [room.solid_set.shapes for room in self.rooms]
        firsts = np.cumsum([0, *map(len, solids)])
        whole = ObstacleSet(shape for shapes in solids for shape in shapes)
        return RoomBatch(whole.packed, firsts)
