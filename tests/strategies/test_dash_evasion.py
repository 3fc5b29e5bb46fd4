"""Test evasion by dashes, on the point that stands for legs."""

from functools import lru_cache
from math import asin, atan2, cos, inf, pi, radians, sin, sqrt

import numpy as np
import pytest

from stepaside.core.poses import ALL_AROUND, Sector
from stepaside.games import duel
from stepaside.games.floor_games import floor_of, play_floor
from stepaside.games.game import GameRules
from stepaside.planning import GaitSettings
from stepaside.sim.person_settings import PersonSettings
from stepaside.strategies import (
    DashEvasion,
    Knowledge,
    Limits,
    Strategy,
    load_strategy,
)
from stepaside.strategies.velocity_set import AxisValues, VelocitySet
from stepaside.studies.tournament import StrategyTrack, track_of

LEGS = VelocitySet(
    (-0.7, 0.7), (-0.35, 0.35), (-0.9, 0.9), AxisValues(0.3, 0.4, 0.1)
)
GAIT = GaitSettings(
    speed=0.5, gain=0.4, stride=0.2, single_support=0.3, double_support=0.1
)
STEP_ASIDE = DashEvasion()


def play(
    person: PersonSettings,
    bearing: float,
    *,
    strategy: Strategy = STEP_ASIDE,
    legs: VelocitySet = LEGS,
    distance: float = 7.0,
    duration: float = 7.0,
) -> StrategyTrack:
    """Play a person who comes from a bearing, in [rad]."""
    x, y = distance * cos(bearing), distance * sin(bearing)
    game = duel(
        duration=duration,
        person=person,
        pursuer={"body": "person", "start": (x, y, bearing + pi)},
        evader={"gait": GAIT, "start": (0.0, 0.0, 0.0)},
    )
    world = floor_of(game, {"evader": strategy}, 0.02, legs)
    return track_of(*play_floor(world, GameRules(duration), 0.02))


@lru_cache(maxsize=8)
def walker(bearing: int, miss: float = 0.0) -> StrategyTrack:
    """Return the game of a straight walker at 1.4 m/s."""
    person = PersonSettings("straight", 1.4, miss=miss)
    return play(person, radians(bearing))


@pytest.mark.parametrize("bearing", [0, 60, 90, 135, 180])
def test_a_straight_walker_is_avoided(bearing: int) -> None:
    game = walker(bearing)
    assert game.closest_distance > 1.0
    moved = np.hypot(*(game.evader[-1] - game.evader[0])[:2])
    assert moved < 2.0  # it stands again
    speed = np.hypot(*np.diff(game.evader[-20:, :2], axis=0).T) / 0.02
    assert speed.max() < 0.02


def test_standing_is_hit_and_passers_by_are_let_pass() -> None:
    stands = play(
        PersonSettings("straight", 1.4), 0.0, strategy=load_strategy("stand")
    )
    assert stands.closest_distance < 0.05
    passing = walker(30, miss=1.2)
    assert np.ptp(passing.evader, axis=0).max() == 0.0


def test_mirrored_walkers_are_avoided_on_mirrored_paths() -> None:
    left, right = walker(60, miss=0.3), walker(-60, miss=-0.3)
    np.testing.assert_allclose(
        left.evader[:, :2] * [1, -1], right.evader[:, :2], atol=1e-6
    )


@pytest.mark.parametrize("bearing", [0, 100, -170])
def test_a_wary_robot_keeps_room_for_a_turn(bearing: int) -> None:
    """The person would pass at 1.2 m, and turns to the robot 1.7 m away."""
    distance, miss, near = 7.0, 1.2, 1.7
    course = atan2(miss, distance)
    aside, along = distance * sin(course), distance * cos(course)
    walked = along - sqrt(near**2 - aside**2)
    x, y = walked * cos(course), walked * sin(course)
    turn = atan2(-y, distance - x) - course
    person = PersonSettings(
        "straight", 1.4, miss=miss, turn_after=walked, turn=turn
    )
    wary = play(person, radians(bearing), strategy=load_strategy("wary"))
    assert wary.closest_distance > 0.7
    # Of those who walk on, it keeps as clear as the one that expects it.
    straight = play(
        PersonSettings("straight", 1.4),
        radians(bearing),
        strategy=load_strategy("wary"),
    )
    assert straight.closest_distance > 1.0


@pytest.mark.parametrize("bearing", [0, 60, 90])
def test_the_body_turns_its_fast_axis_along_the_dash(bearing: int) -> None:
    path = walker(bearing).evader
    moved = path[-1] - path[0]
    assert np.hypot(*moved[:2]) > 0.8
    across = moved[1] * cos(path[-1, 2]) - moved[0] * sin(path[-1, 2])
    assert abs(across) < 0.35 * np.hypot(*moved[:2])


def test_a_chaser_keeps_near_the_distance_of_the_homicidal_chauffeur() -> None:
    """A point of 0.9 m/s and a person of 1.4 m/s who turns within 4 m."""
    point = VelocitySet((-0.9, 0.9), (-0.9, 0.9), (-1.0, 1.0))
    radius, ratio = 4.0, 0.9 / 1.4
    bound = radius * (sqrt(1 - ratio**2) + ratio * asin(ratio) - 1)
    person = PersonSettings("steer", 1.4, 10.0, turning_radius=radius)
    matador = DashEvasion(turning_radius=radius, enough=inf)
    game = play(person, 0.0, strategy=matador, legs=point, duration=20.0)
    assert 0.85 * bound < game.closest_distance < 1.15 * bound


AHEAD, BEHIND = Sector(0.0, pi / 2), Sector(pi, pi / 2)


@pytest.mark.parametrize(
    ("views", "side"), [(ALL_AROUND, -1), ((AHEAD,), 1), ((AHEAD, BEHIND), -1)]
)
def test_a_dash_keeps_the_person_in_view(
    views: tuple[Sector, ...], side: int
) -> None:
    """The faster end of these legs would turn away."""
    lags = AxisValues(0.65, 0.71, 0.53)
    legs = VelocitySet((-0.7, 0.76), (-0.54, 0.53), (-0.84, 0.84), lags)
    limits = Limits(0.1, 0.2, 0.04, 0.4, legs, views=views)
    memory = STEP_ASIDE.begin()
    for i in range(12):
        known = Knowledge(0.05 * i, radians(80), 2.8 - 0.05 * i, limits)
        intent, memory = STEP_ASIDE.decide(known, memory)
    assert intent.velocity is not None
    assert side * intent.velocity.turn > 0.0
