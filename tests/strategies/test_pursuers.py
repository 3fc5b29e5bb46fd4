"""Test the pursuers beside the paper's."""

from dataclasses import replace
from math import atan2, cos, hypot, inf, pi, sin
from typing import Any

import numpy as np
import pytest

from floor_duels import play_steps
from stepaside.core.poses import Pose, wrap_angle
from stepaside.strategies import Evasion, Knowledge, Limits, Pursuit

NAO = Limits(0.1, 0.2, 0.04, 0.4)
START = (Pose(0.0, 0.0, 0.4), Pose(1.2, 0.3, 2.0))
ASIDE = Evasion(safety_radius=100.0)


def turning_evader() -> list[Knowledge]:
    """Return the sightings of an evader on a circle, a step apart."""
    seen = []
    for n in range(5):
        theta = 0.3 + 0.1 * n
        x, y = sin(theta) - 5.0, -cos(theta) - 1.0
        seen.append(
            Knowledge(
                0.4 * n,
                wrap_angle(atan2(y, x) - 0.7),
                hypot(x, y),
                NAO,
                pose_in_map=Pose(5.0, 1.0, 0.7),
            )
        )
    return seen


def test_a_lead_points_ahead_along_the_tangent_of_a_circle() -> None:
    """The course is exact for a steady turn, from three sightings on."""
    pursuer = Pursuit(lead=0.4)
    memory = pursuer.begin()
    for n, seen in enumerate(turning_evader()):
        intent, memory = pursuer.decide(seen, memory)
        theta, reach = 0.3 + 0.1 * n, 0.4 * seen.distance
        x = sin(theta) + reach * cos(theta) - 5.0
        y = -cos(theta) + reach * sin(theta) - 1.0
        if n > 1:
            aim = wrap_angle(atan2(y, x) - 0.7)
            assert intent.heading == pytest.approx(aim, abs=1e-9)


def test_without_parameters_it_is_the_pursuer_of_the_paper() -> None:
    for bearing in (-2.0, 0.1, 1.5):
        assert heading(Pursuit(), known(bearing)) == bearing


def test_noise_depends_on_seed_and_step_alone() -> None:
    noisy, other = Pursuit(noise=0.5), Pursuit(noise=0.5, seed=1)
    errors = [
        [heading(each, replace(known(0.0), time=0.4 * n)) for n in range(200)]
        for each in (noisy, noisy, other)
    ]
    assert errors[0] == errors[1] != errors[2]
    assert np.std(errors[0]) == pytest.approx(0.5, rel=0.2)


def known(bearing: float, distance: float = 1.0, **more: Any) -> Knowledge:
    return Knowledge(0.0, bearing, distance, NAO, **more)


def heading(strategy: Any, knowledge: Knowledge) -> float:
    intent = strategy.decide(knowledge, strategy.begin())[0]
    assert intent.speed_factor == 1.0
    return float(intent.heading)


@pytest.mark.parametrize("ratio", [0.3, 1.0, 1.5, 4.0])
@pytest.mark.parametrize("bearing", [-pi, -1.1, -0.2, 0.0, 0.4, 2.0, pi])
def test_a_gain_multiplies_the_bearing_up_to_the_largest_turn(
    ratio: float, bearing: float
) -> None:
    wanted = min(max(ratio * bearing, -pi), pi)
    found = heading(Pursuit(gain=ratio), known(bearing))
    assert found == (bearing if ratio == 1.0 else pytest.approx(wanted))


@pytest.mark.parametrize("bearing", [-2.5, -0.251, -0.1, 0.0, 0.2, 0.5, pi])
def test_a_sharp_pursuer_turns_by_the_clipped_bearing(bearing: float) -> None:
    """A step turns by kappa = 0.08 of the heading, by 0.08 pi at most."""
    turn = 0.08 * heading(Pursuit(gain=inf), known(bearing))
    assert turn == pytest.approx(min(max(bearing, -0.08 * pi), 0.08 * pi))


def test_greater_gains_end_on_the_closer_circle_of_theory() -> None:
    """Closed form beside games: 2 v sin(w / kp) / w, w = a / (1/kp + 1/ke)."""
    for ratio in (1.5, 2.0, 3.0):
        rate = 0.5 * pi / (1.0 / (0.2 * ratio) + 1.0 / 0.2)
        theory = 0.2 * sin(rate / (0.2 * ratio)) / rate
        pursuer = Pursuit(gain=ratio)
        track = play_steps(pursuer, ASIDE, START, 750, capture=0.01)
        assert track.distances[-1] == pytest.approx(theory, rel=0.01)


@pytest.mark.parametrize("pose", [(0.7, -0.3, 1.0), (-0.5, 1.1, -2.9)])
def test_herding_bisects_the_bearings_of_evader_and_center(
    pose: tuple[float, float, float],
) -> None:
    x, y, theta = pose
    middle = wrap_angle(atan2(-y, -x) - theta)
    strategy = Pursuit(pull=1.0)
    for bearing in (-2.0, -0.6, 0.3, 1.7, 3.0):
        aside = wrap_angle(middle - bearing)
        found = heading(strategy, known(bearing, 0.8, pose_in_map=Pose(*pose)))
        wanted = wrap_angle(bearing + 0.5 * aside)
        assert wrap_angle(found - wanted) == pytest.approx(0.0, abs=1e-9)
    # In the middle of the room there is nothing to keep it from.
    there = Pose(0.0, 0.0, theta)
    assert heading(strategy, known(0.4, pose_in_map=there)) == pytest.approx(
        0.4
    )
