"""Test sums and rates over several robots with cameras."""

from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("cv2")

from stepaside.games.camera_senses import SightObserver  # noqa: E402
from stepaside.games.sight_evaluation import FrameCounts  # noqa: E402

COUNT = st.integers(0, 50)


@st.composite
def tallies(draw: st.DrawFn) -> FrameCounts:
    """Return the frames of a camera, some with detections."""
    shown = draw(COUNT)
    return FrameCounts(shown, draw(st.integers(0, shown)), draw(COUNT))


@given(st.lists(st.tuples(tallies(), tallies(), st.floats(0, 9)), max_size=3))
def test_rates_are_of_all_frames_and_times_are_added(
    robots: list[tuple[FrameCounts, FrameCounts, float]],
) -> None:
    evaluators: Any = {
        f"robot {i}": SimpleNamespace(
            colour=colour,
            depth=depth,
            summary=lambda lost=lost: SimpleNamespace(lost_s=lost),
        )
        for i, (colour, depth, lost) in enumerate(robots)
    }
    found = SightObserver(evaluators, "rays", every=1).report().together
    each = [tally for robot in robots for tally in robot[:2]]
    shown = sum(tally.in_view for tally in each)
    assert (found.detection_rate is None) == (shown == 0)
    if found.detection_rate is not None:
        hits = sum(tally.detected for tally in each)
        assert found.detection_rate == pytest.approx(hits / shown)
        assert 0.0 <= found.detection_rate <= 1.0
    assert found.false_detections == sum(tally.false for tally in each)
    assert found.lost_s == pytest.approx(sum(lost for *_, lost in robots))
    for tally in each:
        if tally.rate is not None:
            assert tally.rate == pytest.approx(tally.detected / tally.in_view)
