"""Test tracks: gates, prediction, latency."""

from math import hypot

import numpy as np
import pytest

from stepaside.perception.track import Observation, TargetTrack, Tracker

FRAME = 1.0 / 15.0


def look(
    time: float,
    x: float,
    y: float = 0.0,
    *,
    identified: bool = True,
    along: float = 0.03,
) -> Observation:
    """Return an observation on the x axis."""
    return Observation(time, x, y, 0.0, along, 0.01, identified, True)


def watch(tracker: Tracker, frames: int, x: float, speed: float) -> float:
    """Show a thing that moves along x; returns the time of the last frame."""
    for i in range(frames):
        tracker.observe([look(i * FRAME, x + speed * i * FRAME)])
    return (frames - 1) * FRAME


def test_one_wrong_frame_confirms_no_track() -> None:
    tracker = Tracker()
    tracker.observe([look(0.0, 0.5)])
    assert tracker.main(0.0, 0.0, 0.0) is None
    for time in (0.1, 0.2, 0.3):
        tracker.observe([])
        assert tracker.main(time, 0.0, 0.0) is None


def test_steady_motion_is_predicted() -> None:
    tracker = Tracker()
    now = watch(tracker, 60, 2.0, -0.1)
    track = tracker.main(now, 0.0, 0.0)
    assert track is not None
    assert track.velocity[0] == pytest.approx(-0.1, abs=0.02)
    ahead = 0.2
    x, y = track.position_at(now + ahead)
    true = 2.0 - 0.1 * (now + ahead)
    assert hypot(x - true, y) < 0.01


def test_delayed_frames_count_at_their_exposure() -> None:
    """A delayed frame of a moving object does not pull the track back."""
    prompt, late = TargetTrack(look(0.0, 2.0)), TargetTrack(look(0.0, 2.0))
    for i in range(1, 60):
        prompt.update(look(i * FRAME, 2.0 - 0.3 * i * FRAME))
        late.update(look(i * FRAME, 2.0 - 0.3 * i * FRAME))
    now = 59 * FRAME
    late.update(look(now - 0.15, 2.0 - 0.3 * (now - 0.15)))
    assert late.position_at(now)[0] == pytest.approx(
        prompt.position_at(now)[0], abs=0.005
    )


def test_without_a_recognised_robot_the_nearest_is_main() -> None:
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
    assert track.distance_from(0.0, 0.0, time) == pytest.approx(
        hypot(1.0, 0.8), abs=0.02
    )


def test_covariance_does_not_depend_on_axes() -> None:
    seen = Observation(0.0, 1.0, 1.0, 0.7, 0.2, 0.05, True, True)
    deviations = np.sqrt(np.linalg.eigvalsh(seen.covariance))
    np.testing.assert_allclose(deviations, [0.05, 0.2], atol=1e-12)


def unseen_for(step: float) -> tuple[float, float, float]:
    """Way of a unit speed, what is left of it and variance pushed in."""
    ahead, kept = step, 1.0
    if step > 0.4:
        kept = np.exp(-(step - 0.4) / 0.7)
        ahead = 0.4 + 0.7 * (1.0 - kept)
    return ahead, kept, min(1.0, 0.3 / step)


@pytest.mark.parametrize("step", [0.1, 0.3, 0.39, 0.8, 2.0])
def test_the_covariance_grows_by_speed_and_acceleration(step: float) -> None:
    """Speed 0.25 m/s, acceleration 1 m/s^2, decay after 0.4 s."""
    track = TargetTrack(look(1.0, 2.0))
    ahead, _, share = unseen_for(step)
    variance = 0.03**2 + (0.25 * ahead) ** 2 + share * 0.25 * step**4
    assert track.deviation_at(1.0 + step) == pytest.approx(np.sqrt(variance))


@pytest.mark.parametrize("step", [0.1, 0.39, 0.8, 2.0])
@pytest.mark.parametrize("bearing", [0.0, 0.7, -2.0])
def test_an_update_is_the_best_linear_estimate(
    step: float, bearing: float
) -> None:
    """Two observations against the sum of their informations."""
    first = Observation(0.0, 1.0, -0.5, 0.3, 0.2, 0.05, False, False)
    second = Observation(step, 1.2, -0.4, bearing, 0.1, 0.03, True, True)
    third = Observation(step + 0.2, 1.2, 0.1, 0.5, 0.2, 0.1, False, False)
    ahead, kept, share = unseen_for(step)
    eye = np.eye(2)
    move = np.block([[eye, ahead * eye], [0.0 * eye, kept * eye]])
    spread = np.zeros((4, 4))
    spread[:2, :2] = first.covariance
    spread[2:, 2:] = 0.25**2 * eye
    push = share * np.block(
        [
            [0.25 * step**4 * eye, 0.5 * step**3 * eye],
            [0.5 * step**3 * eye, step**2 * eye],
        ]
    )
    spread = move @ spread @ move.T + push
    measured = np.linalg.inv(second.covariance)
    information = np.linalg.inv(spread)
    before = information @ np.array([1.0, -0.5, 0.0, 0.0])
    before[:2] += measured @ (1.2, -0.4)
    information[:2, :2] += measured
    after = np.linalg.inv(information)
    x, y, vx, vy = after @ before

    track = TargetTrack(first)
    gap = np.array([0.2, 0.1])
    misfit = gap @ np.linalg.inv(spread[:2, :2] + second.covariance) @ gap
    assert track.mahalanobis_squared(second) == pytest.approx(misfit)
    track.update(second)
    assert track.position_at(step) == pytest.approx((x, y))
    assert track.velocity == pytest.approx((vx, vy))
    greatest = np.linalg.eigvalsh(after[:2, :2])[-1]
    assert track.deviation_at(step) == pytest.approx(np.sqrt(greatest))
    # What is known together of place and speed shows in what comes next.
    move = np.block([[eye, 0.2 * eye], [0.0 * eye, eye]])
    spread = (move @ after @ move.T)[:2, :2] + 0.25 * 0.2**4 * eye
    gap = np.array([1.2 - x - 0.2 * vx, 0.1 - y - 0.2 * vy])
    misfit = gap @ np.linalg.inv(spread + third.covariance) @ gap
    assert track.mahalanobis_squared(third) == pytest.approx(misfit)


def test_the_velocity_is_held_and_then_decays() -> None:
    track = TargetTrack(look(0.0, 2.0))
    for i in range(1, 60):
        time = i * FRAME
        track.update(look(time, 2.0 - 0.3 * time, 0.2 * time))
    start, speed = np.array(track.position_at(track.time)), track.velocity
    assert speed == pytest.approx((-0.3, 0.2), abs=0.02)
    for step in (0.1, 0.4, 0.8, 10.0):
        there = track.position_at(track.time + step)
        way = unseen_for(step)[0] * np.array(speed)
        np.testing.assert_allclose(there - start, way, rtol=1e-6)


def test_a_delayed_observation_does_not_turn_back_times() -> None:
    track = TargetTrack(look(1.0, 2.0))
    track.update(look(1.2, 2.0))
    track.update(look(1.1, 2.0))
    assert (track.time, track.observed_at) == (1.2, 1.2)
    assert track.identified_at == 1.2
    track.update(Observation(1.4, 2.0, 0.0, 0.0, 0.1, 0.1, False, False))
    assert (track.time, track.observed_at) == (1.4, 1.4)
    assert track.identified_at == 1.2
