"""Test the example rooms with a pursuer that follows its plans exactly."""

from math import atan2, hypot
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fake_robot import GAIT, FakeLegs, scheme_of
from stepaside.arena import check_initial_poses, load_room
from stepaside.core.poses import Pose, wrap_angle
from stepaside.locomotion.guard import Guard, KnownRoom
from stepaside.locomotion.swept_outline import BodyOutline, lateral_sway
from stepaside.perception.measurement import RobotState, Sighting
from stepaside.planning import ManeuverPlanner
from stepaside.robots.description import load_robot
from stepaside.sim.outline_measurement import measure_outline
from stepaside.strategies import Pursuit

ROOMS = Path(__file__).parents[2] / "examples" / "rooms"
NAO: BodyOutline = measure_outline(load_robot("nao"), GAIT)
MARGIN = 0.02


@pytest.mark.parametrize(
    "file", sorted(ROOMS.glob("*.toml")), ids=lambda f: f.stem
)
def test_pursuer_reaches_a_standing_evader_without_contact(file: Path) -> None:
    """It passes the pillar, the door and the dead end."""
    room = load_room(file)
    assert room.starts is not None
    check_initial_poses(room, room.starts)
    start, other = room.starts
    needs = NAO.radius + MARGIN + lateral_sway(GAIT)
    around = KnownRoom(room, start)
    guard = Guard(around, NAO, ManeuverPlanner(GAIT), margin=MARGIN)
    legs: Any = FakeLegs()
    tick = 0.02
    scheme = scheme_of(
        Pursuit(body_radius=needs), GAIT, legs, tick=tick, guard=guard
    )
    nothing, distance, least = np.zeros(3), np.inf, np.inf
    goal = start.inverse().compose(other)
    for number in range(round(60.0 / tick)):
        now = number * tick
        body = scheme.walk.reference
        legs.torso_heading = body.heading
        away = goal.x - body.com[0], goal.y - body.com[1]
        distance = hypot(*away)
        if distance < 0.3:
            break
        bearing = wrap_angle(atan2(away[1], away[0]) - body.heading)
        seen = Sighting(now, bearing, distance)
        scheme.update(
            RobotState(now, nothing, nothing, nothing, np.zeros(8), seen)
        )
        if number % 10 == 0:
            placed = start.compose(Pose(*body.com[:2], body.heading))
            trunk = placed.transform_points(NAO.trunk)
            solids = guard.surroundings.solids
            least = min(least, float(solids.swept_clearances(trunk[None])[0]))
    assert distance < 0.3
    assert least >= MARGIN - 1e-4
