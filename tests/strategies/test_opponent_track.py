"""Test the track of the opponent."""

from dataclasses import replace
from itertools import pairwise
from math import cos, pi, sin

import pytest

from stepaside.core.poses import Pose
from stepaside.strategies import Knowledge, Limits
from stepaside.strategies.opponent_track import OpponentTrack, track_of_steps

STEP = 0.5
OWN = Pose(1.0, -2.0, 0.3)


def sighted(
    track: OpponentTrack, time: float, sight: float, distance: float
) -> OpponentTrack:
    """Add a sighting in a direction of the floor, of a robot that walks."""
    own = Pose(OWN.x + 0.2 * time, OWN.y - 0.1 * time, OWN.theta)
    x, y = own.x + distance * cos(sight), own.y + distance * sin(sight)
    return track.note(time, (x, y), own)


@pytest.mark.parametrize("every", [0.004, 0.1, STEP])
def test_a_steady_motion_gives_its_rates(every: float) -> None:
    """Closing is positive, turning to the left too."""
    track, time = OpponentTrack(STEP), 0.0
    while time < 3.0:
        track = sighted(track, time, 0.3 * time, 2.0 - 0.2 * time)
        time += every
    assert track.sight_rates == pytest.approx((0.3, 0.2))
    assert len(track.rows) < 30


def test_the_sway_of_a_gait_cycle_drops_out() -> None:
    """Sighted at the end of every step, on the left and on the right."""
    track = OpponentTrack(STEP)
    for step in range(12):
        sway = 0.02 * sin(pi * (step + 0.5))
        track = sighted(track, step * STEP, sway, 1.0 + sway)
        if step >= 2:
            assert track.sight_rates == pytest.approx((0.0, 0.0), abs=1e-12)


@pytest.mark.parametrize("every", [0.004, 0.1, STEP])
def test_a_straight_walk_has_a_constant_velocity(every: float) -> None:
    track, time = OpponentTrack(STEP), 0.0
    while time < 3.0:
        track = track.note(time, (1.0 - 0.8 * time, 0.3 * time))
        assert (track.velocity is None) == (time <= 0.75 * STEP)
        if track.velocity is not None:
            assert track.velocity == pytest.approx((-0.8, 0.3))
        time += every


def test_one_bad_sighting_counts_less_than_a_difference_would() -> None:
    track = OpponentTrack(STEP)
    for i in range(30):
        track = track.note(0.1 * i, (0.0, 0.1 if i == 29 else 0.0))
    assert track.velocity is not None
    assert track.velocity[0] == pytest.approx(0.0)
    assert 0.0 < track.velocity[1] < 0.1 / (3.25 * STEP) * 1.5


def test_a_track_by_steps_keeps_those_of_the_steps() -> None:
    """Sightings at every tick do not crowd them out."""
    track = OpponentTrack(0.4, span=6.0, spacing=0.75)
    for tick in range(400):
        track = track.note(0.004 * tick, (2.0 - 1e-4 * tick, 0.0))
    times = [row.time for row in track.rows]
    assert times[-1] == pytest.approx(399 * 0.004)
    assert all(0.299 <= b - a < 0.31 for a, b in pairwise(times[:-1]))
    assert track.course == pytest.approx(pi)


@pytest.mark.parametrize(("spread", "share"), [(1e-6, 1.0), (10.0, 0.0)])
def test_an_exact_sighting_counts_and_a_vague_one_does_not(
    spread: float, share: float
) -> None:
    """Beside the position that is predicted, here that of before."""
    limits = Limits(0.1, 0.2, 0.04, STEP)
    here = Knowledge(0.0, 0.0, 1.0, limits, pose_in_map=Pose(0.0, 0.0, 0.0))
    track = track_of_steps(None, here)
    later = replace(here, time=STEP, distance=2.0, spread=spread)
    row = track_of_steps(track, later).rows[-1]
    assert row.x == pytest.approx(1.0 + share, abs=1e-3)
