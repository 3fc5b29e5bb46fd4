"""Test the selection among robots that wear one trim."""

from stepaside.perception.target_selection import UnnamedSelection
from stepaside.perception.track import (
    ROBOT_MOTION,
    Observation,
    TargetTrack,
    Tracker,
)


def track(
    number: int, x: float, y: float, *, identified: bool = True
) -> TargetTrack:
    """Return a confirmed track that was seen at time 0."""
    seen = Observation(0.0, x, y, 0.0, 0.03, 0.03, identified, True)
    made = TargetTrack(seen, number, ROBOT_MOTION)
    made.confirmed = True
    return made


def among(*tracks: TargetTrack) -> UnnamedSelection:
    tracker = Tracker(several=True)
    tracker.tracks = list(tracks)
    return UnnamedSelection(tracker, 2)


def test_the_nearest_recognised_robot_is_the_main_one() -> None:
    far, near = track(1, 2.0, 0.0), track(2, 0.0, 1.0)
    other = track(3, 0.3, 0.0, identified=False)  # perhaps a teammate
    selection = among(far, near, other)
    assert selection.recognised(0.1) == [far, near]
    assert selection.main(0.1, 0.0, 0.0) is near
    assert selection.target_id(near) == 2
    assert among(other).main(0.1, 0.0, 0.0) is None


def test_of_more_tracks_than_robots_the_most_certain_count() -> None:
    """Robots that overlap in an image give tracks of uncertain distance."""
    one, two = track(1, 1.0, 0.0), track(2, 0.0, 1.0)
    seen = Observation(0.0, 0.4, 0.0, 0.0, 0.3, 0.03, True, False)
    ghost = TargetTrack(seen, 3, ROBOT_MOTION)
    ghost.confirmed = True
    selection = among(ghost, one, two)
    assert set(selection.recognised(0.1)) == {one, two}
    assert selection.main(0.1, 0.0, 0.0) is not ghost


def test_another_is_taken_only_when_it_is_nearer_by_a_tenth() -> None:
    one, two = track(1, 1.0, 0.0), track(2, 0.0, 1.05)
    selection = among(one, two)
    assert selection.main(0.1, 0.0, 0.0) is one
    assert selection.main(0.1, 0.0, 0.05) is one  # now 1.001 and 1.0 m
    assert selection.main(0.1, 0.0, 0.2) is two


def test_the_head_glances_at_robots_that_are_out_of_view() -> None:
    near, far = track(1, 1.0, 0.0), track(2, 0.0, 2.0)
    near.update(Observation(1.0, 1.0, 0.0, 0.0, 0.03, 0.03, True, True))
    selection = among(near, far)
    times = [1.0 + 0.1 * k for k in range(10)]
    looks = {selection.look(near, time, 0.0, 0.0) for time in times}
    assert looks == {near, far}
    far.update(Observation(1.0, 0.0, 2.0, 1.6, 0.03, 0.03, True, True))
    assert selection.look(near, 1.0, 0.0, 0.0) is near
    assert selection.look(None, 1.0, 0.0, 0.0) is None
