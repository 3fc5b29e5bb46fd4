"""Test the detection of people in scans of a lidar."""

from math import atan2, cos, hypot, pi, sin

import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Array, wrap_angle
from stepaside.games.game_settings import StartSettings
from stepaside.games.game_settings import duel as make_duel
from stepaside.games.players import RobotPlayer
from stepaside.games.recorded_game import RecordedGame
from stepaside.perception.lidar_perception import (
    find_people,
    nearest_ranges,
    standing_returns,
)
from stepaside.sim.person_settings import PersonSettings


def ring(x: float, y: float, radius: float) -> Array:
    """Points on the side of a cylinder that faces the origin."""
    angles = atan2(-y, -x) + np.linspace(-1.3, 1.3, 200)
    found: Array = np.column_stack(
        [x + radius * np.cos(angles), y + radius * np.sin(angles)]
    )
    return found


@pytest.mark.parametrize("bearing", [0.0, 1.0, pi - 0.01, -pi + 0.01, -2.0])
@pytest.mark.parametrize("distance", [0.6, 2.0, 5.0])
def test_a_person_is_found_in_any_direction(
    bearing: float, distance: float
) -> None:
    x, y = distance * cos(bearing), distance * sin(bearing)
    (found,) = find_people(nearest_ranges(ring(x, y, 0.15)))
    assert wrap_angle(found[0] - bearing) == pytest.approx(0.0, abs=0.02)
    assert found[1] == pytest.approx(distance, abs=0.06)


def test_two_legs_are_one_person_and_two_people_are_two() -> None:
    legs = np.concatenate([ring(2.0, 0.1, 0.06), ring(2.1, -0.1, 0.06)])
    assert len(find_people(nearest_ranges(legs))) == 1
    pair = np.concatenate([ring(2.0, 0.7, 0.15), ring(2.0, -0.7, 0.15)])
    assert len(find_people(nearest_ranges(pair))) == 2


def test_a_wall_is_nobody_but_who_stands_before_it_is_found() -> None:
    along = np.linspace(-4.0, 4.0, 4000)
    wall = np.column_stack([np.full_like(along, 3.0), along])
    assert find_people(nearest_ranges(wall)) == []
    both = np.concatenate([wall, ring(2.0, 0.3, 0.15)])
    people = find_people(nearest_ranges(both))
    assert [d for _, d in people] == [pytest.approx(hypot(2, 0.3), abs=0.06)]


def test_a_scan_that_is_turned_finds_the_same() -> None:
    """Also across the last bin: two bins between returns may be empty."""
    ranges = np.full(360, np.inf)
    for n, bins in enumerate(([0, 4, 5], [0, 3, 4], [0, 1, 5], [0, 2, 6])):
        ranges[np.array(bins) + 80 * n] = n + 1.0
    turned = [find_people(np.roll(ranges, n)) for n in range(360)]
    found = [sorted(away for _, away in people) for people in turned]
    np.testing.assert_allclose(found, [found[0]] * 360)


@pytest.mark.parametrize("tilt", [-0.07, 0.0, 0.07])
def test_a_floor_seen_with_a_wrong_tilt_is_nobody(tilt: float) -> None:
    x, y = np.meshgrid(np.linspace(-8.0, 8.0, 81), np.linspace(-8.0, 8.0, 81))
    floor = np.column_stack([x.ravel(), y.ravel(), tilt * x.ravel()])
    assert standing_returns(floor).size == 0
    person = np.column_stack([ring(4.0, 1.0, 0.15), np.full(200, 0.9)])
    seen = standing_returns(np.concatenate([floor, person]))
    assert len(find_people(nearest_ranges(seen))) == 1


def test_a_robot_sees_who_comes_from_behind() -> None:
    duel = RecordedGame(
        make_duel(
            duration=3.0,
            pursuer={"body": "person"},
            person=PersonSettings("straight", 0.8),
            start=StartSettings(4.0, 0.0, pi),
            evader={"strategy": "stand"},
            senses="lidar",
        )
    )
    errors, settled = [], False
    while duel.world.time < 2.0:
        assert duel.tick() is None
        player = duel.in_physics.players[1]
        assert isinstance(player, RobotPlayer)
        sighting = player.scheme.sighting
        if sighting is None or duel.world.time < 0.8:
            continue
        (x, y), (u, v) = (
            each.truth.position_torso_in_world
            for each in duel.in_physics.players
        )
        bearing = atan2(y - v, x - u) - player.truth.heading_in_world
        off = abs(wrap_angle(sighting.bearing - bearing))
        errors.append((off, abs(sighting.distance - hypot(x - u, y - v))))
        settled = sighting.settled
    assert len(errors) > 200 and settled
    bearings, distances = np.array(errors).T
    assert bearings.max() < 0.05 and distances.max() < 0.15


def test_a_lidar_detects_people_only() -> None:
    with pytest.raises(ConfigurationError, match="a lidar detects people"):
        make_duel(senses="lidar")
