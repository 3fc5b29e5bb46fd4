"""Test duels in physics: circle, symmetry and endings."""

from functools import cache

import mujoco
import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.games import DuelRun, DuelSettings, Outcome, run_duel
from stepaside.games.duel_settings import StartSettings
from stepaside.planning import GaitSettings
from stepaside.robots.description import load_robot
from stepaside.sim.physics_settings import PhysicsSettings
from stepaside.sim.world import build_model
from stepaside.strategies import Evasion


@cache
def play(seed: int, duration: float = 70.0) -> DuelRun:
    return run_duel(DuelSettings(seed=seed, duration=duration))


# Tests of one group run in one worker, and share the duel that they look at.
SHARED = pytest.mark.xdist_group("duel 11")


@SHARED
def test_robots_walk_the_circle_together() -> None:
    """Theory: radius 4v/(pi k) = 0.637 m, distance 0.900 m, 90 degrees."""
    run = play(11)
    summary = run.summary
    assert run.outcome is Outcome.COMPLETED
    for player in (summary.pursuer, summary.evader):
        assert player.radius_m == pytest.approx(0.637, rel=0.04)
    assert summary.distance_m == pytest.approx(0.900, rel=0.04)
    assert summary.relative_orientation_deg == pytest.approx(90, abs=3)
    assert summary.converged_at_s is not None
    assert summary.converged_at_s < 60.0
    assert summary.max_com_velocity_jump_m_s < 1e-9
    assert summary.min_zmp_margin_m is not None
    assert summary.min_zmp_margin_m > 0.02


def test_same_seed_gives_the_same_duel_to_the_bit() -> None:
    one = run_duel(DuelSettings(seed=5, duration=8.0)).arrays()
    other = run_duel(DuelSettings(seed=5, duration=8.0)).arrays()
    assert one.keys() == other.keys() and len(one) == 17
    for name, values in one.items():
        np.testing.assert_array_equal(values, other[name])


def test_other_seeds_give_other_starts() -> None:
    starts = {play(seed, 0.1).settings.start for seed in range(5)}
    assert len(starts) == 5


def test_evader_stands_until_its_safety_area_is_entered() -> None:
    start = StartSettings(1.2, 0.0, 0.0)
    result = run_duel(DuelSettings(duration=12.0, start=start))
    triggered = result.summary.triggered_at_s
    assert triggered is not None
    at = int(np.searchsorted(result.times, triggered))
    assert result.distance[at] == pytest.approx(0.8, abs=0.01)
    evader = result.evader.com
    assert np.abs(evader[: at - 1, :2] - evader[0, :2]).max() < 0.005


def test_released_evader_comes_to_rest() -> None:
    """The pursuer first heads away, and the distance grows."""
    settings = DuelSettings(
        duration=14.0,
        start=StartSettings(0.7, 3.1, 0.0),
        strategy=Evasion(angle=0.0, release_distance=1.0),
    )
    result = run_duel(settings)
    assert result.outcome is Outcome.COMPLETED
    times, landings = result.times, result.evader.landings
    assert landings is not None and len(landings) > 2
    assert landings[-1, 0] < times[-1] - 3.0
    rest = result.evader.com[times > times[-1] - 1.0, :2]
    assert np.ptp(rest, axis=0).max() < 0.005


def test_falls_are_detected_and_end_the_duel() -> None:
    """Strides of 10 cm in 0.25 s are not stable without feedback."""
    gait = GaitSettings(
        single_support=0.24, double_support=0.04, stride=0.1, speed=0.25
    )
    settings = DuelSettings(duration=20.0, gait=gait)
    result = run_duel(settings)
    assert result.outcome is Outcome.FALL
    assert "fell" in result.message
    assert result.duration < 20.0


def soles_on_the_floor(
    arrays: dict[str, Array], name: str, landings: Array
) -> Array:
    """Pose of each foot in physics while the other one swings.

    Args:
        arrays: Record of a duel.
        name: Name of the robot.
        landings: Time and side of each footstep. Shape (n, 5).

    Returns:
        x, y, height [m] and heading [rad] of the soles. Shape (n, 4).
    """
    model = build_model({name: load_robot("nao")}, PhysicsSettings())
    data = mujoco.MjData(model)
    found = []
    for time, side, *_ in landings:
        at = np.searchsorted(arrays["times_s"], time + 0.2)
        data.qpos[:] = arrays[f"{name}_qpos"][at]
        mujoco.mj_kinematics(model, data)
        letter = "l" if side > 0.0 else "r"
        sole = data.site(f"{name}/{letter}_sole_center")
        frame = sole.xmat.reshape(3, 3)
        found.append((*sole.xpos, np.arctan2(frame[1, 0], frame[0, 0])))
    return np.array(found)


@SHARED
@pytest.mark.parametrize("name", ["pursuer", "evader"])
def test_planned_footsteps_are_walked_in_physics(name: str) -> None:
    """Step length and turn of the feet match the plan within 2 %."""
    arrays = play(11).arrays()
    landings = arrays[f"{name}_landings"]
    last = arrays["times_s"][-1] - 0.3
    steady = (landings[:, 0] > 40.0) & (landings[:, 0] < last)
    planned = landings[steady]
    walked = soles_on_the_floor(arrays, name, planned)
    assert len(walked) > 50
    assert np.abs(walked[:, 2]).max() < 0.001
    assert step_of(walked[:, :2]) == pytest.approx(
        step_of(planned[:, 2:4]), rel=0.02
    )
    assert turn_of(walked[:, 3]) == pytest.approx(
        turn_of(planned[:, 4]), rel=0.02
    )


def step_of(places: Array) -> float:
    """Return the mean distance between successive footsteps, in [m]."""
    return float(np.hypot(*np.diff(places, axis=0).T).mean())


def turn_of(headings: Array) -> float:
    """Return the mean turn between successive footsteps, in [rad]."""
    return float(np.diff(np.unwrap(headings)).mean())
