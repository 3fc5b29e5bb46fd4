"""Test gaits that are gone through by the joints alone."""

from dataclasses import replace

import pytest

from stepaside.fitting.gait_feasibility import (
    LEAST_LENGTHS,
    choose_zmp_offset,
    feasible_lengths,
    speed_ratio,
    step_loads,
)
from stepaside.planning import GaitSettings
from stepaside.robots.description import load_robot

NAO = load_robot("nao")
GAIT = GaitSettings()


def slow(factor: float):  # type: ignore[no-untyped-def]
    """NAO with slower joints."""
    limits = {n: factor * v for n, v in NAO.speed_limits.items()}
    return replace(NAO, speed_limits=limits)


def test_the_speed_ratio_is_inverse_to_the_limits() -> None:
    share = speed_ratio(NAO, GAIT)
    assert speed_ratio(slow(0.5), GAIT) == pytest.approx(2.0 * share)


def test_slow_joints_get_feasible_shorter_steps() -> None:
    own = slow(0.6 * speed_ratio(NAO, GAIT))
    share = feasible_lengths(own, GAIT)
    assert LEAST_LENGTHS <= share < 1.0
    gait = replace(
        GAIT,
        speed=share * GAIT.speed,
        stride=share * GAIT.stride,
        step_height=share * GAIT.step_height,
    )
    assert speed_ratio(own, gait) <= 1.0
    assert gait.path_interval == pytest.approx(GAIT.path_interval)


def test_the_hip_load_of_a_step_follows_from_the_weight() -> None:
    """The stance hip carries all but its leg, a hip's width aside."""
    torques = dict.fromkeys(NAO.legs, 10.0)
    borne = step_loads(NAO, GAIT, torques)
    share, joint = borne.usual, borne.joint
    assert borne.most > share
    assert joint in ("LHipRoll", "RHipRoll", "LKneePitch", "RKneePitch")
    assert 1.0 < 10.0 * share < 5.3 * 9.81 * 0.1
    half = dict.fromkeys(NAO.legs, 5.0)
    assert step_loads(NAO, GAIT, half).usual == pytest.approx(2.0 * share)


def test_weak_ankles_get_a_zmp_nearer_to_them() -> None:
    """No farther ahead than leaves them something of their torque."""
    strong = dict.fromkeys(NAO.legs, 100.0)
    ankles = [name for name in NAO.legs if name.endswith("AnklePitch")]
    gait = replace(GAIT, zmp_forward=0.03)
    share, borne = choose_zmp_offset(NAO, gait, strong)
    assert share == 1.0 and borne.most < 0.95
    needs = step_loads(NAO, gait, dict.fromkeys(ankles, 1.0)).most
    weak = strong | dict.fromkeys(ankles, needs)
    share, borne = choose_zmp_offset(NAO, gait, weak)
    assert share == 0.5 and borne.most < 0.95
    worse = strong | dict.fromkeys(ankles, 0.05 * needs)
    share, borne = choose_zmp_offset(NAO, gait, worse)
    assert share == 0.0 and borne.most > 0.95
