"""Test the guard of legs with a velocity set."""

from math import cos, hypot, pi, sin

import numpy as np
import pytest

from stepaside.arena import Box, Disc, Obstacle, Room
from stepaside.core.poses import Pose
from stepaside.locomotion.guard import KnownRoom, VelocityGuard
from stepaside.strategies.velocity_set import (
    STILL,
    AxisValues,
    BodyVelocity,
    VelocitySet,
)
from stored_values import compare_stored, summed

ORIGIN = Pose(0.0, 0.0, 0.0)
HALTING = AxisValues(0.3, 0.15, 0.1)
SIDEWAYS = VelocitySet((-0.7, 0.7), (-0.4, 0.4), (-0.9, 0.9), halting=HALTING)
UNICYCLE = VelocitySet((-0.7, 0.7), (0.0, 0.0), (-0.9, 0.9), halting=HALTING)
ROOM = Room(6.0, 4.0, (Disc(1.0, 0.5, 0.4),))
CLEARANCE, DURATION = 0.4, 0.4


def guard_of(velocities: VelocitySet) -> VelocityGuard:
    return VelocityGuard(KnownRoom(ROOM, ORIGIN), velocities, CLEARANCE)


def path(
    velocity: BodyVelocity, pose: Pose, duration: float = DURATION
) -> np.ndarray:
    """Positions until the robot stands, integrated in small steps."""
    x, y, theta = pose
    steps, rows = 400, [(x, y)]
    for _ in range(steps):
        step = duration / steps
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
    for share in np.linspace(0.01, 1.0, 100):
        rows.append(
            (
                x + share * (ahead * cos(theta) - left * sin(theta)),
                y + share * (ahead * sin(theta) + left * cos(theta)),
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


@pytest.mark.parametrize("duration", [0.08, 0.4, 0.547, 1.0])
@pytest.mark.parametrize("gap", [0.2, 0.25, 0.3, 0.38, 0.45])
@pytest.mark.parametrize("kind", ["wall", "pole"])
def test_no_path_leads_through_a_thin_obstacle(
    kind: str, gap: float, duration: float
) -> None:
    """Nor nearer to it, from within the clearance."""
    thin: Obstacle = Box(gap + 0.02, 0.0, 0.04, 3.0)
    if kind == "pole":
        thin = Disc(gap + 0.02, 0.0, 0.02)
    room = Room(8.0, 8.0, (thin,))
    generator = np.random.default_rng(8)
    wishes = [BodyVelocity(0.7), BodyVelocity(0.5, 0.2, 0.9)]
    for _ in range(8):
        drawn = generator.uniform((0.0, -0.4, -0.9), (0.7, 0.4, 0.9))
        wishes.append(BodyVelocity(*drawn.tolist()))
    for velocities in (SIDEWAYS, UNICYCLE):
        guard = VelocityGuard(KnownRoom(room, ORIGIN), velocities, CLEARANCE)
        for wish in map(velocities.nearest, wishes):
            admitted = guard.admit(wish, ORIGIN, duration)
            way = path(admitted, ORIGIN, duration)
            clear = room.solid_set.clearance(way)
            # Chords of arcs are off by less than 1 mm.
            assert clear.min() >= min(CLEARANCE, clear[0]) - 1e-3


def test_the_measured_tube_of_the_legs_is_kept_clear() -> None:
    wish, before_wall = BodyVelocity(0.7), Pose(-1.0, 1.0, pi / 2)
    walls = KnownRoom(ROOM, ORIGIN)
    least = []
    for tube in (0.0, 0.28):
        legs = UNICYCLE._replace(tube=tube)
        guard = VelocityGuard(walls, legs, CLEARANCE)
        pose = before_wall
        for _ in range(20):
            velocity = guard.admit(wish, pose, DURATION)
            x, y = path(velocity, pose)[-1].tolist()
            pose = Pose(x, y, pose.theta)
        least.append(float(ROOM.solid_set.clearance([pose[:2]])[0]))
    assert CLEARANCE <= least[0] < CLEARANCE + 0.28 <= least[1]


def test_an_open_floor_changes_nothing() -> None:
    guard = VelocityGuard(KnownRoom(Room(), ORIGIN), SIDEWAYS, CLEARANCE)
    wish = BodyVelocity(3.0, 1.0, 2.0)
    assert guard.admit(wish, ORIGIN, DURATION) == wish


@pytest.mark.parametrize("velocities", [SIDEWAYS, UNICYCLE], ids=["2", "1"])
def test_velocities_are_admitted_as_stored(velocities: VelocitySet) -> None:
    draw, guard = np.random.default_rng(1), guard_of(velocities)
    found = []
    for _ in range(400):
        place = Pose(*draw.uniform((-3, -2, -3), (3, 2, 3)).tolist())
        wanted = BodyVelocity(*draw.uniform(-1, 1, 3).tolist())
        found.append(guard.admit(wanted, place, DURATION))
    key = f"velocities, {velocities.lateral[1]}"
    compare_stored("walks.json", key, summed(found), 1e-5)
