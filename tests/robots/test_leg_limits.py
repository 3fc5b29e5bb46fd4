"""Test that legs keep to the speeds and ranges of their joints."""

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.robots.description import load_robot
from stepaside.robots.leg_kinematics import BodyReference, LegKinematics

NAO = load_robot("nao")
STANCE = BodyReference(
    (0.02, 0.0, 0.26), (0.0, 0.05, 0.0, 0.0), (0.0, -0.05, 0.0, 0.0)
)
LEGS = ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch")


def standing(tick: float) -> LegKinematics:
    legs = LegKinematics(NAO, tick=tick)
    legs.stand(STANCE)
    return legs


def moved(
    legs: LegKinematics, reference: BodyReference, ticks: int = 1
) -> Array:
    """Greatest move of each joint in a tick, in [rad]."""
    moves = []
    for _ in range(ticks):
        before = legs.joint_targets
        moves.append(np.abs(legs.track(reference) - before))
    greatest: Array = np.array(moves).max(axis=0)
    return greatest


@pytest.mark.parametrize("tick", [0.002, 0.004])
@pytest.mark.parametrize(
    ("com", "joint"),
    [
        ((0.02, 0.0, 0.20), "LKneePitch"),
        ((0.02, 0.0, 0.28), "LKneePitch"),
        ((0.02, 0.08, 0.26), "LHipRoll"),
        ((0.02, -0.08, 0.26), "LHipRoll"),
    ],
)
def test_no_joint_target_exceeds_the_speed_limit(
    com: tuple[float, float, float], joint: str, tick: float
) -> None:
    """A reference that jumps is followed at full speed, and no faster."""
    legs = standing(tick)
    moves = moved(legs, STANCE._replace(com=com), ticks=3)
    names = legs.joint_names
    limits = np.array([NAO.speed_limits[name] for name in names]) * tick
    assert (moves <= limits + 1e-12).all()
    at = names.index(joint)
    assert moves[at] == pytest.approx(limits[at])


def test_a_jump_of_the_reference_is_closed_in_time() -> None:
    legs = standing(0.004)
    there = STANCE._replace(com=(0.03, 0.02, 0.24))
    moved(legs, there, ticks=60)
    assert moved(legs, there).max() < 1e-6
    expected = LegKinematics(NAO, tick=0.004).stand(there)
    np.testing.assert_allclose(legs.joint_targets, expected, atol=2e-4)


def test_knees_stay_within_their_working_limits() -> None:
    """A CoM 3 mm out of reach stretches them to 0.05 rad, not to 0."""
    legs = standing(0.004)
    low, high = NAO.working_limits["LKneePitch"]
    names = legs.joint_names
    knees = [names.index("LKneePitch"), names.index("RKneePitch")]
    moved(legs, STANCE._replace(com=(0.02, 0.0, 0.28)), ticks=60)
    angles = legs.joint_targets[knees]
    assert angles == pytest.approx([low, low])
    assert (low, high) == (0.05, 2.11)
    back = legs.track(STANCE)
    for _ in range(300):
        back = legs.track(STANCE)
    assert (back[knees] > 0.3).all()


def test_every_joint_stays_within_its_range() -> None:
    """Toes turned in farther than the hips can: they stop, and no lock."""
    legs = standing(0.004)
    model = NAO.compile()
    ranges = np.array([model.joint(n).range for n in legs.joint_names])
    of_legs = [n[1:] in LEGS for n in legs.joint_names]
    low, high = ranges[of_legs].T
    for yaw in np.linspace(0.0, 1.2, 80).tolist():
        asked = legs.track(
            STANCE._replace(
                left_foot=(0.0, 0.05, 0.0, -yaw),
                right_foot=(0.0, -0.05, 0.0, yaw),
            )
        )[of_legs]
        assert (asked >= low - 1e-9).all() and (asked <= high + 1e-9).all()
    assert ((asked <= low + 1e-6) | (asked >= high - 1e-6)).any()
