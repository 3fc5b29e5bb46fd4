"""Test recorded trajectories and planning times."""

from math import degrees
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from reference_plans import plan_of
from stepaside.core.poses import Array
from stepaside.games.trajectory import Trajectory, margin_of, tracks_in
from synthetic_run import run_of

SHAPES = {
    "com": (5, 3),
    "torso": (5, 3),
    "place": (5, 3),
    "com_reference": (5, 2),
    "zmp_reference": (5, 2),
    "zmp": (5, 2),
    "qpos": (5, 30),
    "landings": (2, 5),
    "sight": (4, 6),
    "pushes": (2, 6),
    "velocity": (5, 2),
    "tilt": (5, 2),
    "sole": (5, 3),
    "support": (5, 5),
    "heading_reference": (5, 1),
    "estimate": (5, 8),
    "command": (5, 4),
}


def arrays_of(*names: str) -> dict[str, Array]:
    generator = np.random.default_rng(1)
    return {name: generator.random(SHAPES[name]) for name in names}


def test_the_distance_of_a_run_is_between_reference_points() -> None:
    there = [track_at(0.0, 0.0, 0.2), track_at(3.0, 4.0, 1.2)]
    tracks = dict(zip(("pursuer", "evader"), there, strict=True))
    run = run_of(np.arange(2.0), tracks, converged_at_s=0.0)
    np.testing.assert_allclose(run.distance, 5.0)
    np.testing.assert_allclose(run.orientation, degrees(1.0))
    assert run.circle is not None
    np.testing.assert_allclose(run.circle[:2], [1.5, 2.0])


def track_at(x: float, y: float, heading: float) -> Trajectory:
    """Return a trajectory at one reference point, with the torso elsewhere."""
    rows = np.tile([x, y, heading], (2, 1))
    return Trajectory(rows + 0.7, rows + [0.3, 0.1, 0.5] + x, rows)


@pytest.mark.parametrize(
    "names",
    [tuple(SHAPES), ("com", "torso"), ("com", "torso", "zmp", "sight")],
)
def test_a_trajectory_is_converted_to_arrays_and_back(
    names: tuple[str, ...],
) -> None:
    """Missing arrays have no name, and are None again."""
    track = Trajectory(**arrays_of(*names))
    told = track.arrays("evader")
    assert set(told) == {f"evader_{name}" for name in names}
    other = Trajectory(**arrays_of("com", "torso")).arrays("pursuer")
    found = tracks_in(told | other | {"times_s": np.zeros(5)}, ("evader",))
    assert set(found) == {"evader"}
    for name in SHAPES:
        value, again = getattr(track, name), getattr(found["evader"], name)
        if name in names:
            np.testing.assert_array_equal(again, value)
        else:
            assert value is again is None


def test_margins_are_of_the_executed_parts() -> None:
    """Later parts of a plan do not count."""
    plans: list[Any] = [
        SimpleNamespace(
            schedule=SimpleNamespace(first_step_duration=duration),
            margin=lambda upto, least=least: least - 0.01 * upto,
        )
        for duration, least in ((0.5, 0.05), (1.5, 0.04), (0.2, 0.03))
    ]
    assert margin_of(plans) == pytest.approx(0.025)
    assert margin_of(plans[:1]) == pytest.approx(0.045)
    assert margin_of([]) is None


def test_the_margin_of_plans_is_the_smallest_of_each() -> None:
    plans = [plan_of("start"), plan_of("walk"), plan_of("halt")]
    margins = [p.margin(p.schedule.first_step_duration) for p in plans]
    assert len(set(margins)) > 1 and min(margins) > 0.0
    assert margin_of(plans) == min(margins)
