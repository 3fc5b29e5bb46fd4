"""Test that an ideal body walks and turns as planned."""

import numpy as np
import pytest

from stepaside.games.game_settings import walk
from stepaside.games.recorded_game import RecordedGame
from walkers import walker_of

CYCLES = 12


@pytest.mark.parametrize(
    ("bearing", "backward"), [(0.0, False), (0.785, True)]
)
def test_an_ideal_body_walks_its_plan(bearing: float, backward: bool) -> None:
    """Within 1 % over whole gait cycles, without feedback."""
    settings = walk(duration=20.0, bearing=bearing, backward=backward)
    gait = settings.gait
    cycle = 2.0 * gait.step_duration
    walking = RecordedGame(settings, recorded=False, endless=True)
    been: list[tuple[float, ...]] = []
    while walking.world.time < settings.duration - 1e-9:
        assert walking.tick() is None, walking.message
        truth = walker_of(walking).truth
        been.append(
            (*truth.position_reference_in_world, truth.heading_in_world)
        )
    ticks = cycle / walking.in_physics.physics.tick
    span, first = round(CYCLES * ticks), round(ticks)
    rows = np.array(been[-span - first :])
    # From every phase of the gait: sway is no way, nor is it radius.
    before, after = rows[:-first], rows[first:]
    ways = np.hypot(*(after - before)[:, :2].T)
    heading = np.unwrap(rows[:, 2])
    turned = float((heading[first:] - heading[:-first]).mean())
    turn = 2.0 * gait.gain * gait.path_interval * bearing
    way = 2.0 * gait.stride * np.sinc(0.5 * turn / np.pi)
    assert ways.mean() == pytest.approx(way, rel=0.008)
    assert turned == pytest.approx(turn, abs=1e-3)
