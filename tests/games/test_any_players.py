"""Games of one, two and three players in figures, pages and films."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.games.outcome import Outcome
from stepaside.games.recorded_game import run_walk
from stepaside.games.run import Run
from stepaside.games.run_captions import describe_state
from stepaside.games.trajectory import Trajectory
from stepaside.games.walk_settings import WalkSettings

NAMES = ("walker", "hare", "tortoise")
PUSH = np.array([[0.1, 0.1, 0.3, -0.2, 0.0, 0.8]])


@cache
def game(count: int) -> Run:
    """Return robots that walk abreast, 1 m apart; the last is pushed."""
    alone = run_walk(WalkSettings(duration=0.4))
    tracks = {
        name: _beside(alone.walker, float(number))
        for number, name in enumerate(NAMES[:count])
    }
    last = NAMES[count - 1]
    tracks[last] = replace(tracks[last], pushes=PUSH)
    return Run(
        name="abreast",
        settings=alone.settings,
        outcome=Outcome.COMPLETED,
        message="played 0.40 s",
        duration=alone.duration,
        times=alone.times,
        tracks=tracks,
        summary=alone.summary,
    )


def _beside(track: Trajectory, y: float) -> Trajectory:
    assert track.qpos is not None
    columns = {"com": 1, "torso": 1, "qpos": 1}
    moved: dict[str, Array] = {}
    for name, column in columns.items():
        moved[name] = getattr(track, name).copy()
        moved[name][:, column] += y
    return replace(track, place=None, **moved)


by_count = pytest.mark.parametrize("count", [1, 2, 3])


@by_count
def test_a_run_has_its_players_and_the_least_distance(
    count: int,
) -> None:
    run = game(count)
    assert run.players == run.robots == NAMES[:count]
    assert run.theory is None and run.safety is None and run.circle is None
    if count == 1:
        assert run.pair is None and not run.has_orientation
        assert np.isnan(run.distance).all()
    else:
        assert run.has_orientation is (count == 2)
        np.testing.assert_allclose(run.distance, 1.0)
        assert len(run.opponents) == (1 if count == 2 else 3)
    if count == 2:
        np.testing.assert_allclose(run.orientation, 0.0, atol=1e-9)
    assert run.pushed_at(0.05) == () and run.pushed_at(0.1) == (
        NAMES[count - 1],
    )
    if count > 1:
        names = " and ".join(NAMES[:count])
        assert describe_state(run, 0) == f"{names} in motion"
        assert describe_state(run, 10) == f"{NAMES[count - 1]} is pushed"
