"""Test following things through frames: gates, memory, latency."""

from math import hypot

import numpy as np
import pytest

from stepaside.sensing.track import Observation, Track
from stepaside.sensing.tracker import PATIENCE, Tracker

FRAME = 1.0 / 15.0


def look(
    time: float,
    x: float,
    y: float = 0.0,
    *,
    identified: bool = True,
    along: float = 0.03,
) -> Observation:
    """Something seen along the x axis."""
    return Observation(time, x, y, 0.0, along, 0.01, identified, True)


def watch(tracker: Tracker, frames: int, x: float, speed: float) -> float:
    """Show a thing that moves along x; returns the time of the last frame."""
    for i in range(frames):
        tracker.observe([look(i * FRAME, x + speed * i * FRAME)])
    return (frames - 1) * FRAME


def test_one_wrong_frame_is_nobody() -> None:
    tracker = Tracker()
    tracker.observe([look(0.0, 0.5)])
    assert tracker.main(0.0, 0.0, 0.0) is None
    for time in (0.1, 0.2, 0.3):
        tracker.observe([])
        assert tracker.main(time, 0.0, 0.0) is None


def test_one_wrong_frame_moves_no_one_who_is_known() -> None:
    tracker = Tracker()
    now = watch(tracker, 20, 1.5, 0.0)
    tracker.observe([look(now + FRAME, 0.5)])
    track = tracker.main(now + FRAME, 0.0, 0.0)
    assert track is not None
    assert track.away_from(0.0, 0.0, now + FRAME) == pytest.approx(
        1.5, abs=0.02
    )


def test_three_frames_confirm() -> None:
    tracker = Tracker()
    now = watch(tracker, 2, 1.0, 0.0)
    assert tracker.main(now, 0.0, 0.0) is None
    now = watch(tracker := Tracker(), 3, 1.0, 0.0)
    assert tracker.main(now, 0.0, 0.0) is not None


def test_steady_motion_is_foreseen() -> None:
    tracker = Tracker()
    now = watch(tracker, 60, 2.0, -0.1)
    track = tracker.main(now, 0.0, 0.0)
    assert track is not None
    assert track.velocity[0] == pytest.approx(-0.1, abs=0.02)
    ahead = 0.2
    x, y = track.place_at(now + ahead)
    true = 2.0 - 0.1 * (now + ahead)
    assert hypot(x - true, y) < 0.01


def test_doubt_grows_unseen_until_memory_ends() -> None:
    tracker = Tracker()
    now = watch(tracker, 20, 1.0, 0.0)
    track = tracker.main(now, 0.0, 0.0)
    assert track is not None
    doubts = [track.deviation_at(now + t) for t in np.linspace(0, 2, 9)]
    assert all(a < b for a, b in zip(doubts, doubts[1:], strict=False))
    assert tracker.main(now + PATIENCE + 0.1, 0.0, 0.0) is None


def test_late_frames_count_for_when_they_were_taken() -> None:
    """A frame of the past, of a thing that moves, does not pull it back."""
    prompt, late = Track(look(0.0, 2.0)), Track(look(0.0, 2.0))
    for i in range(1, 60):
        prompt.correct(look(i * FRAME, 2.0 - 0.3 * i * FRAME))
        late.correct(look(i * FRAME, 2.0 - 0.3 * i * FRAME))
    now = 59 * FRAME
    late.correct(look(now - 0.15, 2.0 - 0.3 * (now - 0.15)))
    assert late.place_at(now)[0] == pytest.approx(
        prompt.place_at(now)[0], abs=0.005
    )


def test_the_other_robot_counts_before_what_stands_nearer() -> None:
    tracker = Tracker()
    for i in range(5):
        time = i * FRAME
        tracker.observe(
            [look(time, 1.5), look(time, 1.0, 0.8, identified=False)]
        )
    track = tracker.main(time, 0.0, 0.0)
    assert track is not None
    assert track.away_from(0.0, 0.0, time) == pytest.approx(1.5, abs=0.02)


def test_without_another_robot_the_nearest_counts() -> None:
    tracker = Tracker()
    for i in range(5):
        time = i * FRAME
        tracker.observe(
            [
                look(time, 2.5, identified=False),
                look(time, 1.0, 0.8, identified=False),
            ]
        )
    track = tracker.main(time, 0.0, 0.0)
    assert track is not None
    assert track.away_from(0.0, 0.0, time) == pytest.approx(
        hypot(1.0, 0.8), abs=0.02
    )


def test_covariance_does_not_depend_on_axes() -> None:
    seen = Observation(0.0, 1.0, 1.0, 0.7, 0.2, 0.05, True, True)
    deviations = np.sqrt(np.linalg.eigvalsh(seen.covariance))
    np.testing.assert_allclose(deviations, [0.05, 0.2], atol=1e-12)
