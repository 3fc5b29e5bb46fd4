"""Test where the opponent of a recorded play was."""

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.games.play_conversion import (
    opponent_trajectory,
    sight_table,
    sightings_in,
)
from stepaside.games.play_rows import PlayedRows


@pytest.mark.parametrize("late", [0.0, 0.2, 0.5])
@pytest.mark.parametrize("began", [0.0, 40.0])
def test_a_standing_player_is_recorded_where_it_stands(
    late: float, began: float
) -> None:
    """However late, by a robot that walks and turns, on its own clock."""
    times: Array = 0.02 * np.arange(300, dtype=np.float64)
    own = np.column_stack(
        [0.1 * times, np.sin(0.3 * times), 0.6 * times + 2.0]
    )
    other = 2.0, -1.0
    taken = np.floor(times / 0.1) * 0.1 - late
    there = np.array([np.interp(taken, times, c) for c in own.T]).T
    x, y = other[0] - there[:, 0], other[1] - there[:, 1]
    seen = np.column_stack(
        [taken + began, np.arctan2(y, x) - there[:, 2], np.hypot(x, y)]
    )
    seen[taken < 0.0] = np.nan
    seen[200:220] = np.nan
    columns = {"times_s": times + began, "sighting": seen}
    found = sightings_in(PlayedRows(columns, times, ()))
    track = opponent_trajectory(found, times, own)
    assert track is not None
    np.testing.assert_allclose(
        track.torso[:, :2], np.broadcast_to(other, (300, 2)), atol=2e-3
    )
    known = found[~np.isnan(found[:, 1])]
    delays = known[:, 0] - known[:, 1]
    assert delays.max() == pytest.approx(late, abs=0.021)
    table = sight_table(found)
    assert table[:, 5].sum() == 1.0 and table.shape[1] == 6
    np.testing.assert_array_equal(table[:, 1:3], found[:, 2:])
