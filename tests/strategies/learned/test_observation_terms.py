"""Test what a learned strategy observes."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from stepaside.arena import Room
from stepaside.arena.shapes import Disc
from stepaside.core.errors import PolicyError
from stepaside.core.poses import Pose
from stepaside.strategies.knowledge import Knowledge, Limits
from stepaside.strategies.learned import SENSED_TERMS, observe, width_of

TERMS = tuple(SENSED_TERMS)
STEPS = Limits(0.1, 0.2, 0.04, 0.4)
KNOWN = Knowledge(
    3.0,
    0.7,
    1.2,
    STEPS,
    bearing_rate=0.15,
    closing_speed=0.04,
    moving=True,
    pose_in_map=Pose(0.3, -0.2, 0.5),
    obstacles_in_map=Room(3.0, 3.0, (Disc(0.8, 0.1, 0.2),)).solid_set,
)


def test_a_gait_twice_as_large_and_half_as_fast_observes_the_same() -> None:
    scaled = replace(
        KNOWN,
        distance=2 * KNOWN.distance,
        bearing_rate=0.15 / 2,
        limits=Limits(0.1, 0.1, 0.08, 0.8),
        obstacles_in_map=Room(6.0, 6.0, (Disc(1.6, 0.2, 0.4),)).solid_set,
        pose_in_map=Pose(0.6, -0.4, 0.5),
    )
    np.testing.assert_allclose(
        observe(scaled, TERMS), observe(KNOWN, TERMS), atol=1e-6
    )


def test_rates_are_those_of_path_time() -> None:
    """A walker plays the same path at 0.4 / 0.547 of the pace."""
    walker = replace(STEPS, step_duration=0.547)
    slower = 0.4 / 0.547
    walked = replace(
        KNOWN,
        limits=walker,
        bearing_rate=0.15 * slower,
        closing_speed=0.04 * slower,
    )
    np.testing.assert_allclose(
        observe(walked, TERMS), observe(KNOWN, TERMS), rtol=1e-6
    )


def test_a_mirrored_knowledge_is_observed_mirrored() -> None:
    mirrored = replace(
        KNOWN,
        bearing=-0.7,
        bearing_rate=-0.15,
        pose_in_map=Pose(0.3, 0.2, -0.5),
        obstacles_in_map=Room(3.0, 3.0, (Disc(0.8, -0.1, 0.2),)).solid_set,
    )
    sides = np.array([1, 1, -1, -1, 1, 1, *[1] * 17])
    # Directions of a ring, from ahead to the left, the other way round.
    order = [*range(7), *(7 + -np.arange(8) % 8), *(15 + -np.arange(8) % 8)]
    np.testing.assert_allclose(
        observe(mirrored, TERMS), (sides * observe(KNOWN, TERMS))[order]
    )


def test_clearance_around_is_measured_in_the_room() -> None:
    wall = replace(
        KNOWN,
        pose_in_map=Pose(1.0, 0.0, -pi / 2),
        obstacles_in_map=Room(3.0, 3.0).solid_set,
    )
    found = observe(wall, ("clearances",)) * 0.5
    # The wall at x = 1.5 is to the left: 0.5, and 0.2 from a point at 0.3.
    np.testing.assert_allclose(found[[0, 1, 3, 7]], [0.5, 0.5, 0.2, 0.8])


def test_an_unknown_term_is_refused() -> None:
    with pytest.raises(PolicyError, match="unknown .* 'speed'; there are"):
        width_of(("distance", "speed"))
