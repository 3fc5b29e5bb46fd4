"""Decisions of all strategies, alone and among others, as stored.

Each plays 10 s against a scripted opponent, on the gait of NAO, in a room
among others, and on legs of any direction, in ``tests/data/decisions.json``.
"""

from math import atan2, cos, hypot, pi, sin
from typing import Any

import pytest

from stepaside.arena import Box, Disc, Room
from stepaside.core.player_identity import PlayerIdentity, Role
from stepaside.core.poses import Pose, Sector, wrap_angle
from stepaside.planning import Direction
from stepaside.strategies.knowledge import Knowledge, Limits, OtherPlayer
from stepaside.strategies.registry import STRATEGIES, load_strategy
from stepaside.strategies.velocity_set import AxisValues, VelocitySet
from stored_values import compare_stored, summed

pytestmark = pytest.mark.xdist_group("stored-games")
ROOM = Room(5.0, 4.0, obstacles=(Disc(0.9, 0.6, 0.2), Box(-1, -1, 0.4, 0.3)))
NAO = Limits(0.1, 0.2, 0.04, 0.4)
LAGS = AxisValues(0.3, 0.4, 0.2)
LEGS = VelocitySet((-0.4, 0.7), (-0.3, 0.35), (-0.8, 0.9), LAGS)
KINDS: dict[str, dict[str, Any]] = {
    "open": {"limits": NAO},
    "room": {"limits": NAO, "obstacles_in_map": ROOM.solid_set},
    "legs": {
        "limits": Limits(0.5, 0.4, 0.2, 0.4, LEGS, views=(Sector(0.3, 1.2),))
    },
}
MORE = (
    "evasion(angle=0.6, saturated=true, safety_radius=1.2)",
    "evasion(trigger=time, release_distance=2, side_hysteresis=0.1)",
    "pursuit(gain=3, lead=0.3, pull=0.2, noise=0.1)",
    "goal(goal=(1.5, -0.4))",
)


def others_of(x: float, y: float, time: float) -> Any:
    """Yield name, role and place of players around a place."""
    yield "red", Role.PURSUER, x + 1.1 * cos(time), y + 0.4 + 0.6 * sin(time)
    yield "ruby", Role.PURSUER, x - 0.7 + 0.1 * time, y - 0.1
    yield "green", Role.EVADER, x + 0.3, y + 1.3 - 0.1 * time
    yield "guest", Role.BYSTANDER, x + 2.0 - 0.2 * time, y + 0.1


def played(name: str, kind: str) -> list[list[float]]:
    """Return heading, speed and velocity of each decision, and the pose."""
    strategy: Any = load_strategy(name)
    limits, memory = KINDS[kind]["limits"], strategy.begin()
    backward = strategy.direction is Direction.BACKWARD
    role = Role.EVADER if backward else Role.PURSUER
    own, opponent = Pose(0.2, -0.3, 0.4), Pose(1.5, 0.7, -2.0)
    found, moving = [], False
    for step in range(24):
        time = 0.4 * step
        x, y = opponent.x - own.x, opponent.y - own.y
        sight = atan2(y, x) - own.theta
        others = tuple(
            OtherPlayer(
                PlayerIdentity(each, kind_of, kind_of.value),
                wrap_angle(atan2(v - own.y, u - own.x) - own.theta),
                hypot(u - own.x, v - own.y),
                (0.1 * cos(time), -0.05),
            )
            for each, kind_of, u, v in others_of(own.x, own.y, time)
        )
        known = Knowledge(
            time,
            wrap_angle(sight),
            hypot(x, y),
            pose_in_map=own,
            moving=moving,
            age=0.02,
            velocity=(0.1 * cos(sight + pi), 0.1 * sin(sight + pi)),
            identity=PlayerIdentity("blue", role, role.value),
            others=others if kind == "room" else (),
            **KINDS[kind],
        )
        intent, memory = strategy.decide(known, memory)
        moving = intent.walks
        speed = 0.4 * limits.speed * intent.speed_factor
        turn = limits.share * intent.heading * moving
        move = Pose(-speed if backward else speed, 0.0, turn)
        velocity = intent.velocity or (0.0, 0.0, 0.0)
        if intent.velocity:
            move = Pose(*(0.4 * each for each in velocity))
        own = own.compose(move)
        course = atan2(-y, -x) + 0.6 * sin(0.7 * time)
        pace = 0.4 * limits.speed * 1.4
        opponent = Pose(
            opponent.x + pace * cos(course),
            opponent.y + pace * sin(course),
            course,
        )
        found.append([intent.heading, intent.speed_factor, *velocity, *own])
    return found


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", [*STRATEGIES, *MORE])
def test_decisions_are_those_that_are_stored(name: str, kind: str) -> None:
    found = played(name, kind)
    sums = [each for row in found[::5] for each in [*summed(row)][1:]]
    compare_stored("decisions.json", f"{name} {kind}", sums)
