"""Test how a walk begins, is evaluated and ends."""

from math import inf, pi
from typing import Any

import mujoco
import numpy as np
import pytest

from fake_players import clock
from fake_robot import walk_of
from stepaside.core.errors import ReachError
from stepaside.games.game import Ended, Progress
from stepaside.games.outcome import Outcome
from stepaside.games.recorded_game import RecordedGame, run_walk
from stepaside.games.support_foot_columns import upright_samples
from stepaside.games.walk_settings import WalkSettings
from stepaside.locomotion.walk_snapshots import Phase
from stepaside.locomotion.zmp.control_settings import STABILISED
from stepaside.locomotion.zmp.mpc import MpcResult
from stepaside.planning import Direction
from stepaside.sim.body_settings import BODIES
from stepaside.sim.push import Push
from stepaside.strategies import Walk
from walkers import walker_of


def way(bearing: float, *, backward: bool = False) -> tuple[float, float]:
    """Return forward and leftward displacement after 3.5 s, in [m]."""
    walking = RecordedGame(WalkSettings(bearing=bearing, backward=backward))
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


def test_the_settings_decide_the_direction() -> None:
    for backward in (False, True):
        settings = WalkSettings(bearing=0.3, backward=backward)
        walker = walker_of(RecordedGame(settings))
        strategy: Any = walker.scheme.decisions.strategy
        wanted = Direction.BACKWARD if backward else Direction.FORWARD
        assert strategy == Walk(0.3, wanted)
    walking = RecordedGame(WalkSettings())
    assert abs(walker_of(walking).truth.heading_in_world) < 1e-9
    walking.tick()
    sighting = walker_of(walking).scheme.sighting
    assert sighting is not None and sighting.distance == inf
    assert walker_of(walking).is_moving
    hardware = RecordedGame(WalkSettings(body=BODIES["hardware"], seed=3))
    assert hardware.in_physics.physics.tick == 0.012
    other = RecordedGame(WalkSettings(body=BODIES["hardware"], seed=4))
    masses = [w.in_physics.model.body_mass for w in (hardware, other)]
    assert np.abs(masses[0] - masses[1]).max() > 1e-4


def test_a_fall_is_detected_by_truth_reach_or_the_robot_itself() -> None:
    walking = RecordedGame(WalkSettings())
    assert walking.tick() is None
    scheme: Any = walker_of(walking).scheme
    walk_of(scheme).phase = Phase.FALLEN
    scheme.update = lambda measured: scheme.joint_targets
    assert walking.tick() is Outcome.FALL
    assert walking.message == "walker fell at 0.01 s"
    walk_of(scheme).phase, walking.ended = Phase.WALKING, None
    assert walking.tick() is None
    data = walking.in_physics.data
    data.qpos[2:7] = (1.0, 0.5**0.5, 0.5**0.5, 0.0, 0.0)
    mujoco.mj_forward(walking.in_physics.model, data)
    assert walking.tick() is Outcome.FALL

    def out_of_reach(measured: object) -> Any:
        raise ReachError("too far")

    other = RecordedGame(WalkSettings())
    scheme = walker_of(other).scheme
    scheme.update = out_of_reach
    assert other.tick() is Outcome.UNREACHABLE and other.in_physics.ticks == 0
    assert other.message == "walker lost its footing at 0.00 s: too far"


def test_a_walk_that_falls_ends_there(monkeypatch: pytest.MonkeyPatch) -> None:
    tick = RecordedGame.advance

    def clumsy(walking: RecordedGame) -> None:
        tick(walking)
        if walking.in_physics.ticks >= 40:
            walking.ended = Ended(Outcome.FALL, "")

    monkeypatch.setattr(RecordedGame, "advance", clumsy)
    result = run_walk(WalkSettings(duration=3.0))
    assert result.outcome is Outcome.FALL
    assert result.duration == pytest.approx(0.16)
    # Of a robot that lies there is one sample, which counts for nothing.
    np.testing.assert_allclose(
        result.times, [*(0.02 * np.arange(8)), 0.16], atol=1e-12
    )
    even = upright_samples(result.times, result.outcome)
    assert even.tolist() == 8 * [True] + [False]


@pytest.mark.parametrize(
    ("duration", "ticks"), [(0.1, 25), (0.0999, 25), (0.1001, 26)]
)
def test_a_walk_lasts_its_duration(duration: float, ticks: int) -> None:
    result = run_walk(WalkSettings(duration=duration))
    assert result.outcome is Outcome.COMPLETED
    assert result.message == f"played {0.004 * ticks:.2f} s"
    assert result.duration == pytest.approx(0.004 * ticks)
    due = 0.02 * np.arange(ticks // 5 + 1)
    last = [] if ticks % 5 == 0 else [0.004 * ticks]
    np.testing.assert_allclose(result.times, [*due, *last], atol=1e-12)
    even = upright_samples(result.times, result.outcome)
    np.testing.assert_allclose(result.times[even], due, atol=1e-12)
    # The footstep that is being made counts.
    told = result.summary
    assert told.steps == 1 and told.adapted_steps == 0
    assert told.qp is None and told.push_impulse_n_s == (0.0, 0.0)
    assert told.min_zmp_margin_m is not None
    assert told.min_zmp_margin_m > 0.02


def test_steps_and_pushes_of_a_walk_are_counted() -> None:
    pushes = (Push(0.1, 0.5, 0.0), Push(0.05, 1.0, pi / 2))
    settings = WalkSettings(duration=3.0, pushes=pushes)
    result = run_walk(settings)
    gait = settings.gait
    # The first step begins after the start support.
    steps = (3.0 - gait.start_support) / gait.step_duration
    assert abs(result.summary.steps - steps) <= 1.0
    given = result.summary.push_impulse_n_s
    assert given == pytest.approx((0.1, 0.05), abs=0.01)
    rows = result.walker.pushes
    assert rows is not None
    np.testing.assert_allclose(rows[:, 0], [0.5, 1.0])
    np.testing.assert_allclose(rows[:, 1], 0.1)
    np.testing.assert_allclose(rows[:, 4:].sum(axis=0), given, atol=1e-3)
    for time, _, x, y, *_ in rows:
        at = result.walker.torso[result.index_at(time)]
        np.testing.assert_allclose((x, y), at[:2], atol=2e-3)
    assert result.settings == settings.resolved()


def solved(iterations: int) -> MpcResult:
    """Return the result of a solver after some iterations."""
    values: dict[str, Any] = dict.fromkeys(MpcResult._fields)
    values |= {"time": 1e-4, "feasible": True, "excess": (0.0, 0.0)}
    return MpcResult(**(values | {"iterations": iterations}))


def test_feedback_is_summarised(monkeypatch: pytest.MonkeyPatch) -> None:
    tick = RecordedGame.advance

    def adapted(walking: RecordedGame) -> None:
        balance: Any = walk_of(walker_of(walking).scheme).balance
        balance.stabiliser.adapted = 7
        answer = solved(walking.in_physics.ticks)
        balance.stabiliser.zmp_feedback.solved = answer
        tick(walking)

    monkeypatch.setattr(RecordedGame, "advance", adapted)
    result = run_walk(WalkSettings(duration=0.012, control=STABILISED))
    assert result.summary.adapted_steps == 7
    assert result.summary.qp is not None and result.summary.qp.solves == 3
    assert result.summary.qp.iterations == pytest.approx(1.0)


def test_an_interrupted_walk_is_recorded(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock(monkeypatch, 0.05)

    def interrupt(progress: Progress) -> None:
        raise KeyboardInterrupt

    result = run_walk(WalkSettings(duration=3.0), interrupt)
    assert result.outcome is Outcome.INTERRUPTED
    assert result.message == "interrupted at 0.02 s"
    assert result.duration == pytest.approx(0.02)
    np.testing.assert_allclose(result.times, [0.0, 0.02], atol=1e-12)
