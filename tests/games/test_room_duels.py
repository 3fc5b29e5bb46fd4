"""Test duels in rooms: obstacles, starts, contacts and files."""

from dataclasses import replace
from typing import Any

import mujoco
import numpy as np
import pytest

from stepaside.arena import Box, Disc, Polygon, Room
from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Pose
from stepaside.games.game_settings import GameSettings, StartSettings, duel
from stepaside.games.recorded_game import RecordedGame
from stepaside.locomotion.control_settings import MapSettings
from stepaside.sim.room_furnishing import HEIGHT, add_solids

TRIANGLE = Polygon(((0.5, 0.5), (0.9, 0.5), (0.7, 0.9)))
FULL = Room(
    3.0, 3.0, (Disc(-0.6, 0.2, 0.15), Box(0.4, -0.7, 0.3, 0.2, 0.5), TRIANGLE)
)
STARTS = (Pose(-1.1, -1.1, 0.8), Pose(-1.1, 0.9, -1.5))


def placed(room: Room, **changes: Any) -> GameSettings:
    return duel(room=room, **changes)


def test_obstacles_in_the_world_are_those_of_the_room() -> None:
    """Rays from above hit the obstacles of the room."""
    spec = mujoco.MjSpec()
    add_solids(spec, FULL)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    random = np.random.default_rng(5)
    points = random.uniform(-1.55, 1.55, (3000, 2))
    clearance = np.min([s.clearance(points) for s in FULL.solids], axis=0)
    found = np.zeros(1, dtype=np.int32)
    for (x, y), away in zip(points, clearance, strict=True):
        down = mujoco.mj_ray(
            model, data, [x, y, 2.0], [0.0, 0.0, -1.0], None, 1, -1, found
        )
        if abs(away) > 1e-4:
            wanted = 2.0 - HEIGHT if away < 0.0 else -1.0
            assert down == pytest.approx(wanted, abs=1e-6)


def test_a_room_excludes_other_starts_and_a_map_of_people() -> None:
    room = replace(FULL, starts=STARTS)
    for name in ("distance", "pursuer_offset", "evader_offset"):
        with pytest.raises(ConfigurationError, match=f"start.{name} must be"):
            RecordedGame(placed(room, start=StartSettings(**{name: 1.0})))
    with pytest.raises(ConfigurationError, match="there are no people"):
        placed(
            room,
            pursuer={"body": "person"},
            senses="cameras",
            map=MapSettings(source="seen"),
        )
    assert placed(room, pursuer={"body": "person"}).robots == ("evader",)
