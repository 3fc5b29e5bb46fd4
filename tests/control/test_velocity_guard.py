"""Test the guard of legs with a velocity set."""

from math import cos, hypot, pi, sin

import numpy as np
import pytest

from stepaside.arena import Disc, Room
from stepaside.control.clearance.surroundings import KnownRoom
from stepaside.control.clearance.velocity_guard import VelocityGuard
from stepaside.core.poses import Pose
from stepaside.strategies.velocity_set import (
    STILL,
    AxisValues,
    BodyVelocity,
    VelocitySet,
)

ORIGIN = Pose(0.0, 0.0, 0.0)
HALTING = AxisValues(0.3, 0.15, 0.1)
SIDEWAYS = VelocitySet((-0.7, 0.7), (-0.4, 0.4), (-0.9, 0.9), halting=HALTING)
UNICYCLE = VelocitySet((-0.7, 0.7), (0.0, 0.0), (-0.9, 0.9), halting=HALTING)
ROOM = Room(6.0, 4.0, (Disc(1.0, 0.5, 0.4),))
CLEARANCE, DURATION = 0.4, 0.4


def guard_of(velocities: VelocitySet) -> VelocityGuard:
    return VelocityGuard(KnownRoom(ROOM, ORIGIN), velocities, CLEARANCE)


def path(velocity: BodyVelocity, pose: Pose) -> np.ndarray:
    """Positions until the robot stands, integrated in small steps."""
    x, y, theta = pose
    steps, rows = 400, [(x, y)]
    for _ in range(steps):
        step = DURATION / steps
        middle = theta + 0.5 * velocity.turn * step
        x += step * (
            velocity.forward * cos(middle) - velocity.lateral * sin(middle)
        )
        y += step * (
            velocity.forward * sin(middle) + velocity.lateral * cos(middle)
        )
        theta += velocity.turn * step
        rows.append((x, y))
    ahead = HALTING.forward * velocity.forward / 0.7
    left = HALTING.lateral * velocity.lateral / 0.4
    rows.append(
        (
            x + ahead * cos(theta) - left * sin(theta),
            y + ahead * sin(theta) + left * cos(theta),
        )
    )
    return np.array(rows)


@pytest.mark.parametrize("velocities", [SIDEWAYS, UNICYCLE])
def test_an_admitted_velocity_keeps_clear_until_the_robot_stands(
    velocities: VelocitySet,
) -> None:
    guard, generator = guard_of(velocities), np.random.default_rng(4)
    changed = 0
    for _ in range(300):
        pose = Pose(
            *generator.uniform((-2.6, -1.6, -pi), (2.6, 1.6, pi)).tolist()
        )
        wish = velocities.nearest(
            BodyVelocity(*generator.uniform(-0.7, 0.7, 3).tolist())
        )
        if ROOM.solid_set.clearance([pose[:2]])[0] < CLEARANCE:
            continue
        admitted = guard.admit(wish, pose, DURATION)
        least = ROOM.solid_set.clearance(path(admitted, pose)).min()
        # The guard samples the path at a few points.
        assert least >= CLEARANCE - 2e-3
        keeps = ROOM.solid_set.clearance(path(wish, pose)).min()
        if keeps >= CLEARANCE + 2e-3:
            assert admitted == wish
        changed += admitted != wish
    assert 30 < changed < 270


def test_a_robot_that_can_step_sideways_slides_along_a_wall() -> None:
    before_wall = Pose(-1.0, 1.55, pi / 4)
    wish = BodyVelocity(0.5, 0.0, 0.0)
    found = guard_of(SIDEWAYS).admit(wish, before_wall, DURATION)
    assert hypot(*found[:2]) > 0.2
    along = (
        found.forward * cos(pi / 4) - found.lateral * sin(pi / 4),
        found.forward * sin(pi / 4) + found.lateral * cos(pi / 4),
    )
    assert along[0] > 0.2 and along[1] < 0.05
    slowed = guard_of(UNICYCLE).admit(wish, before_wall, DURATION)
    assert slowed.lateral == 0.0 and slowed.forward < 0.2


def test_a_robot_too_near_may_move_away_only() -> None:
    too_near = Pose(-1.0, 1.7, 0.0)  # 0.3 m from the wall
    away = BodyVelocity(0.0, -0.3, 0.0)
    guard = guard_of(SIDEWAYS)
    assert guard.admit(away, too_near, DURATION) == away
    assert guard_of(UNICYCLE).admit(
        BodyVelocity(0.5, 0.0, 0.0), too_near, DURATION
    ) in (STILL, BodyVelocity(0.0, 0.0, 0.0))


def test_an_open_floor_changes_nothing() -> None:
    guard = VelocityGuard(KnownRoom(Room(), ORIGIN), SIDEWAYS, CLEARANCE)
    wish = BodyVelocity(3.0, 1.0, 2.0)
    assert guard.admit(wish, ORIGIN, DURATION) == wish
