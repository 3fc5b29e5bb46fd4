"""Test how a walk begins, is evaluated and ends."""

import numpy as np
import pytest

from stepaside.games.game import Outcome
from stepaside.games.game_settings import walk
from stepaside.games.recorded_game import RecordedGame, run_game
from walkers import walker_of


def way(bearing: float, *, backward: bool = False) -> tuple[float, float]:
    """Return forward and leftward displacement after 3.5 s, in [m]."""
    walking = RecordedGame(walk(bearing, backward=backward))
    x, y = walker_of(walking).truth.position_torso_in_world
    while walking.world.time < 3.5:
        assert walking.tick() is None
    u, v = walker_of(walking).truth.position_torso_in_world
    return u - x, v - y


def test_a_robot_walks_where_its_bearing_points() -> None:
    """Circles to the left and to the right are mirror images."""
    ahead, aside = way(0.0)
    assert ahead > 0.1 and abs(aside) < 0.02
    left, right = way(0.8), way(-0.8)
    assert left[1] > 0.01 and right[1] < -0.01
    assert left[0] == pytest.approx(right[0], abs=0.02)
    assert way(0.0, backward=True)[0] < -0.1


@pytest.mark.parametrize(
    ("duration", "ticks"), [(0.1, 25), (0.0999, 25), (0.1001, 26)]
)
def test_a_walk_lasts_its_duration(duration: float, ticks: int) -> None:
    result = run_game(walk(duration=duration))
    assert result.outcome is Outcome.COMPLETED
    assert result.message == f"played {0.004 * ticks:.2f} s"
    assert result.duration == pytest.approx(0.004 * ticks)
    due = 0.02 * np.arange(ticks // 5 + 1)
    last = [] if ticks % 5 == 0 else [0.004 * ticks]
    np.testing.assert_allclose(result.times, [*due, *last], atol=1e-12)
    # The footstep that is being made counts.
    walking, planning = result.summary.walking, result.summary.planning
    assert walking is not None and planning is not None
    assert planning.steps == 1 and walking.adapted_steps == 0
    assert walking.solver is None
    assert walking.push_impulse_n_s == (0.0, 0.0)
    assert planning.min_zmp_margin_m is not None
    assert planning.min_zmp_margin_m > 0.02
