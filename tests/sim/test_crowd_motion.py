"""Test how people react to others: forces, and reactions to robots."""

from math import atan2, cos, hypot, pi, sin
from types import SimpleNamespace
from typing import Any

import pytest

from stepaside.arena import NO_OBSTACLES
from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Pose
from stepaside.games.people import walk_of
from stepaside.sim.crowd_motion import (
    NOTICES,
    CrowdMotion,
    Neighbour,
    Vector,
    group_force,
    social_force,
)
from stepaside.sim.person_motion import PersonMotion
from stepaside.sim.person_settings import CrowdSettings, PersonSettings

STEP = 0.02  # in [s]
ROBOT = (0.0, 0.0)


def walk(reaction: str, duration: float = 10.0) -> list[Pose]:
    """Poses of a person who walks at a robot that stands."""
    person = PersonSettings("straight", 1.0, reaction=reaction)
    motion = PersonMotion(person, Pose(6.0, 0.2, pi), ROBOT)
    poses = [motion.pose]
    for i in range(round(duration / STEP)):
        motion.advance((i + 1) * STEP, STEP, ROBOT)
        poses.append(motion.pose)
    return poses


def closest(poses: list[Pose]) -> float:
    return min(hypot(pose.x, pose.y) for pose in poses)


def test_social_forces_do_not_depend_on_the_frame() -> None:
    offset, velocity = (1.0, 0.4), (-1.2, 0.1)
    fx, fy = social_force(offset, velocity)
    assert fx > 0.0  # away from the other one
    for angle in (1.0, 2.5, -2.0):
        c, s = cos(angle), sin(angle)

        def turned(v: Vector, c: float = c, s: float = s) -> Vector:
            return c * v[0] - s * v[1], s * v[0] + c * v[1]

        found = social_force(turned(offset), turned(velocity))
        assert found == pytest.approx(turned((fx, fy)), abs=1e-12)


def test_two_who_meet_head_on_pass_each_other_on_the_right() -> None:
    goals = (6.0, 0.0), (-6.0, 0.0)
    pair = [
        CrowdMotion(CrowdSettings(1.2), Pose(-x, 0.0, heading), (x, 0.0))
        for (x, _), heading in zip(goals, (0.0, pi), strict=True)
    ]
    gaps = []
    for i in range(600):
        seen = [Neighbour(*m.pose[:2], is_person=True) for m in pair]
        for own, other in zip(pair, reversed(seen), strict=True):
            own.advance((i + 1) * STEP, STEP, [other])
        (x, y, _), (u, v, _) = pair[0].pose, pair[1].pose
        gaps.append((hypot(x - u, y - v), y - v))
    nearest, aside = min(gaps)
    assert nearest > 0.5 and aside < 0.0
    assert all(motion.arrived_at is not None for motion in pair)


def test_a_surprised_person_halts_and_looks_then_walks_on() -> None:
    poses = walk("surprised", duration=50.0)
    # It notices the robot at 4 m, and needs some way to halt.
    notice = NOTICES["surprised"]
    then, later = (poses[round(t / STEP)] for t in (10.0, notice.lasts))
    assert hypot(later.x - then.x, later.y - then.y) < 1e-3
    assert notice.within - 1.0 < hypot(*then[:2]) < notice.within
    assert cos(then.theta - atan2(-then.y, -then.x)) > 0.999
    assert poses[-1].x < -4.0


def test_curious_and_scared_people_keep_their_distances() -> None:
    assert 1.2 < hypot(*walk("curious", duration=25.0)[-1][:2]) < 1.6
    assert closest(walk("scared")) > 1.5


def test_a_threatening_person_stands_in_front_of_a_robot() -> None:
    poses = walk("threatening", duration=20.0)
    assert 0.7 < hypot(*poses[-1][:2]) < 1.3
    # A robot that walks is blocked ahead.
    settings = CrowdSettings(1.4, "threatening")
    motion = CrowdMotion(settings, Pose(3.0, 0.0, pi), (-3.0, 0.0))
    for i in range(400):
        robot = Neighbour(0.0, 0.4 * i * STEP, is_person=False)
        motion.advance((i + 1) * STEP, STEP, [robot])
    x, y, _ = motion.pose
    assert abs(x) < 0.5 and 0.5 < y - robot.y < 1.5


def test_members_of_a_group_come_together_but_not_too_near() -> None:
    assert group_force((0.0, 0.0), []) == (0.0, 0.0)
    assert group_force((3.0, 0.0), [(0.0, 0.0)])[0] < -1.0
    assert group_force((0.2, 0.0), [(0.0, 0.0)])[0] > 0.0


def test_reactions_need_a_straight_path() -> None:
    with pytest.raises(ConfigurationError, match="straight path"):
        PersonSettings("steer", reaction="curious")
    with pytest.raises(ConfigurationError, match="straight path"):
        PersonSettings("straight", reaction="curious", halt_after=1.0)
    with pytest.raises(ConfigurationError, match="reaction"):
        PersonSettings("straight", reaction="angry")


def test_a_person_in_a_game_walks_around_a_robot_that_stands() -> None:
    robot = SimpleNamespace(name="robot", body="robot", team="", radius=0.3)
    own = SimpleNamespace(
        **{"name": "guest", "body": "person", "team": "", "radius": 0.25},
        crowd=CrowdSettings(1.2),
        goal=(6.0, 0.0),
        pose=Pose(-3.0, 0.0, 0.0),
    )
    settings: Any = SimpleNamespace(players=[robot, own], solids=NO_OBSTACLES)
    stands = Pose(2.0, 0.05, 0.0)
    walk, gaps = walk_of(settings, own, STEP), []  # type: ignore[arg-type]
    for i in range(400):
        walk.decide(i * STEP, {"robot": stands})
        before = walk.pose.x
        walk.advance((i + 0.5) * STEP)
        half = walk.pose.x - before
        walk.advance((i + 1) * STEP)
        assert walk.pose.x - before == pytest.approx(2.0 * half, abs=1e-9)
        gaps.append(hypot(walk.pose.x - stands.x, walk.pose.y - stands.y))
    assert min(gaps) > 0.4 and walk.pose.x > 4.0
