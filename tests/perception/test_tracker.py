"""Test the tracker: association, merging, pruning, main track."""

import pytest

from stepaside.perception.track import Observation, TargetTrack, Tracker


def look(
    time: float,
    x: float,
    y: float = 0.0,
    *,
    identified: bool = False,
    along: float = 0.03,
) -> Observation:
    """Return an observation on the x axis with equal deviations."""
    return Observation(time, x, y, 0.0, along, along, identified, True)


def known(
    time: float, x: float, y: float = 0.0, *, identified: bool = False
) -> TargetTrack:
    """A confirmed track."""
    track = TargetTrack(look(time, x, y, identified=identified))
    track.confirmed = True
    return track


def tracker_of(*tracks: TargetTrack) -> Tracker:
    tracker = Tracker()
    tracker.tracks = list(tracks)
    return tracker


def test_the_gate_decides_between_update_and_new_track() -> None:
    """Four deviations of both together: 0.17 m."""
    for gap, same in ((0.160, True), (0.179, False)):
        track = known(0.0, 1.0)
        tracker = tracker_of(track)
        (updated,) = tracker.observe([look(0.0, 1.0 + gap)])
        assert (updated is track) is same
        assert len(tracker.tracks) == (1 if same else 2)


def test_each_track_takes_its_nearest_observation() -> None:
    near, far = known(0.0, 1.0), known(0.0, 2.0)
    tracker = tracker_of(far, near)
    seen = [look(0.1, 2.02), look(0.1, 1.04), look(0.1, 1.01)]
    updated = tracker.observe(seen, may_start=False)
    assert len(updated) == 2 and near in updated and far in updated
    assert near.position_at(0.1)[0] == pytest.approx(1.01, abs=0.005)
    assert far.position_at(0.1)[0] == pytest.approx(2.02, abs=0.008)
    assert tracker.tracks == [far, near]


@pytest.mark.parametrize(("gap", "one"), [(0.13, True), (0.17, False)])
def test_two_tracks_at_one_position_merge_into_the_older(
    gap: float, one: bool
) -> None:
    for order in (1, -1):
        older = known(0.0, 1.0)
        younger = known(0.1, 1.0, gap, identified=True)
        tracker = tracker_of(*[older, younger][::order])
        main = tracker.main(0.2, 0.0, 0.0)
        assert main is (older if one else younger)
        assert len(tracker.tracks) == (1 if one else 2)
        assert older.identified_at == (0.1 if one else float("-inf"))


@pytest.mark.parametrize(("lapse", "older"), [(0.45, True), (0.55, False)])
def test_of_two_recognised_tracks_the_older_is_main(
    lapse: float, older: bool
) -> None:
    """A new one may be a false detection."""
    for order in (1, -1):
        first = known(0.0, 2.0, identified=True)
        late = known(lapse, 1.0, identified=True)
        first.update(look(lapse, 2.0))
        main = tracker_of(*[first, late][::order]).main(lapse, 0.0, 0.0)
        assert main is (first if older else late)


def test_unconfirmed_tracks_are_not_main() -> None:
    unsure = TargetTrack(look(0.0, 1.0, identified=True))
    sure = known(0.0, 2.0)
    assert tracker_of(unsure, sure).main(0.1, 0.0, 0.0) is sure
