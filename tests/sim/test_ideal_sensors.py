"""Test the ideal line of sight: geometry, rate, delay and noise."""

from math import atan2, hypot, pi
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from stepaside.perception.measurement import Sighting
from stepaside.sim.ground_truth import IdealLineOfSight, hides
from stepaside.sim.physics_settings import SightSettings

OWN: Any = SimpleNamespace(
    position_reference_in_world=(1.0, 2.0), heading_in_world=2.5
)
OTHER: Any = SimpleNamespace(
    position_reference_in_world=(-0.5, 1.6), heading_in_world=0.0
)
TICK = 0.004


def look(**settings: float) -> IdealLineOfSight:
    generator = np.random.default_rng(5)
    return IdealLineOfSight(OWN, OTHER, SightSettings(**settings), generator)


def read(sight: IdealLineOfSight, now: float) -> Sighting:
    seen = sight.read(now)
    assert seen is not None
    return seen


def test_the_ideal_sighting_is_exact_and_immediate() -> None:
    sight = look()
    for tick in range(5):
        time, bearing, distance, *_ = read(sight, tick * TICK)
        assert time == tick * TICK
        assert distance == pytest.approx(hypot(1.5, 0.4))
        # Beyond half a turn: the short way, which is to the left.
        expected = atan2(-0.4, -1.5) - 2.5 + 2 * pi
        assert bearing == pytest.approx(expected)
        assert 0.0 < bearing < 1.0


def test_a_sighting_is_held_until_the_next() -> None:
    sight = look(rate=10.0)
    times = [read(sight, tick * TICK).time for tick in range(101)]
    taken = sorted(set(times))
    np.testing.assert_allclose(taken, [0.0, 0.1, 0.2, 0.3, 0.4])
    ages = np.arange(101) * TICK - times
    assert ages.max() == pytest.approx(0.1 - TICK)


def test_a_delay_postpones_sightings() -> None:
    sight = look(delay=0.02)
    assert sight.read(0.0) is None
    assert sight.read(0.016) is None
    assert read(sight, 0.02).time == 0.0
    assert read(sight, 0.034).time == 0.0
    assert read(sight, 0.036).time == 0.016
    assert read(sight, 0.056).time == pytest.approx(0.036)


def test_noise_has_the_set_deviation_and_no_bias() -> None:
    sight = look(bearing_noise=0.05, distance_noise=0.1)
    seen = np.array([read(sight, i * TICK)[:3] for i in range(4000)])
    true = atan2(-0.4, -1.5) - 2.5 + 2 * pi
    for values, mean, deviation in (
        (seen[:, 1], true, 0.05),
        (seen[:, 2], hypot(1.5, 0.4), 0.1),
    ):
        assert values.mean() == pytest.approx(mean, abs=deviation / 12.0)
        assert values.std() == pytest.approx(deviation, rel=0.05)
    assert abs(np.corrcoef(seen[:, 1], seen[:, 2])[0, 1]) < 0.06


def body(x: float, y: float, *, reach: float = 0.4, com: float = 0.27) -> Any:
    return SimpleNamespace(
        position_reference_in_world=(x, y),
        position_com_in_world=(x, y, com),
        heading_in_world=0.0,
        reach=reach,
    )


@pytest.mark.parametrize(
    ("between", "hidden"),
    [
        (body(1.0, 0.1), True),
        (body(1.0, -0.13), True),
        (body(1.0, 0.2), False),  # beside the line
        (body(2.5, 0.0), False),  # behind the player
        (body(-0.5, 0.0), False),  # behind the eye
        (body(1.0, 0.0, com=0.1), False),  # too low
        (body(1.0, 0.0, com=0.24), True),  # of about its height
        (body(1.0, 0.3, reach=1.0), True),  # a wide one
    ],
)
def test_a_body_hides_what_is_behind_it(between: Any, hidden: bool) -> None:
    eye, seen = body(0.0, 0.0), body(2.0, 0.0)
    assert hides(between, eye, seen) is hidden


def test_a_hidden_player_is_seen_where_it_was() -> None:
    eye, seen, between = body(0.0, 0.0), body(2.0, 0.0), body(1.0, 1.0)
    sight = IdealLineOfSight(
        eye,
        seen,
        SightSettings(),
        np.random.default_rng(1),
        between=(between,),
    )
    assert read(sight, 0.0) == Sighting(0.0, 0.0, 2.0)
    between.position_reference_in_world = (1.0, 0.0)
    seen.position_reference_in_world = (3.0, 0.0)
    assert read(sight, TICK) == Sighting(0.0, 0.0, 2.0)
    between.position_reference_in_world = (1.0, 1.0)
    assert read(sight, 2 * TICK) == Sighting(2 * TICK, 0.0, 3.0)
