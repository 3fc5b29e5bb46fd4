"""Test claims on unicycles and plans: each fails under a fault."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from math import exp
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.planning import (
    Direction,
    ManeuverPlan,
    ManeuverPlanner,
    maneuver,
)
from stepaside.planning.path import UnicycleTrajectory, place_footsteps
from stepaside.planning.plan import PlanSamples
from stepaside.studies import theory_claims
from stepaside.studies.claims import ONCE, load_claims
from stepaside.studies.tournament import StrategyTrack, record_steps
from stepaside.theory.unicycle.simulation import PlayedGame
from stepaside.theory.unicycle.unicycle_game import Unicycles

Patch = Callable[[pytest.MonkeyPatch], None]
Pair = tuple[Array, Array]

play = cache(theory_claims.play)  # each game is simulated once for all faults


@cache
def sampled() -> StrategyTrack:
    start = theory_claims.NAO_START.poses()
    return record_steps(theory_claims.SAMPLED.started_at(start))


@pytest.fixture(autouse=True)
def games_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(theory_claims, "play", play)
    monkeypatch.setattr(theory_claims, "record_steps", lambda *_: sampled())


def seen_as(
    change: Callable[[Unicycles, Array, Array, Array], Pair],
) -> Patch:
    """Falsify the poses of every simulated game."""

    def patch(monkeypatch: pytest.MonkeyPatch) -> None:
        def false(game: Unicycles) -> Any:
            run = play(game)

            def poses(times: Any) -> Pair:
                pair = run.poses(times)
                return change(game, np.asarray(times), *pair)

            return SimpleNamespace(
                game=game,
                end_time=run.end_time,
                circle=run.circle,
                poses=poses,
            )

        monkeypatch.setattr(theory_claims, "play", false)

    return patch


def played_as(change: Callable[[Unicycles], Unicycles]) -> Patch:
    """Simulate a modified game."""

    def patch(monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(
            theory_claims, "play", lambda game: play(change(game))
        )

    return patch


def sampled_as(change: Callable[[Array, Array], Pair]) -> Patch:
    """Falsify the poses of the sampled game."""

    def patch(monkeypatch: pytest.MonkeyPatch) -> None:
        def false(*_: Any) -> Any:
            run = sampled()
            pursuer, evader = change(run.pursuer.copy(), run.evader.copy())
            return run._replace(pursuer=pursuer, evader=evader)

        monkeypatch.setattr(theory_claims, "record_steps", false)

    return patch


def poses_as(
    change: Callable[[UnicycleTrajectory, Array, Array], Array],
) -> Patch:
    """Falsify the Cartesian path."""
    right = UnicycleTrajectory.poses

    def false(self: UnicycleTrajectory, times: Any) -> Array:
        t = np.asarray(times, dtype=np.float64)
        return change(self, t, right(self, t))

    return lambda m: m.setattr(UnicycleTrajectory, "poses", false)


def placed_as(change: Callable[[Array], Array], **other: float) -> Patch:
    """Falsify the footsteps along a correct path."""

    def false(path: UnicycleTrajectory, **kwargs: Any) -> Array:
        factors = {name: kwargs[name] * by for name, by in other.items()}
        return change(place_footsteps(path, **(kwargs | factors)))

    return lambda m: m.setattr(maneuver, "place_footsteps", false)


def samples_as(change: Callable[[PlanSamples], PlanSamples]) -> Patch:
    """Falsify the samples of plans."""
    right = ManeuverPlan.sample

    def false(self: ManeuverPlan, times: Any) -> PlanSamples:
        return change(right(self, times))

    return lambda m: m.setattr(ManeuverPlan, "sample", false)


def slow_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    """Advance the clock by 20 ms at every reading."""
    clock = iter(np.arange(0.0, 1e3, 0.02))
    monkeypatch.setattr(theory_claims, "process_time", lambda: next(clock))


def one_side(path: UnicycleTrajectory, _: Array, poses: Array) -> Array:
    """Apply eq. (10) as printed."""
    poses[..., 1] *= np.sign(path.bearing)
    return poses


def printed_heading(
    path: UnicycleTrajectory, times: Array, poses: Array
) -> Array:
    """Apply eq. (11) as printed."""
    turning = np.minimum(times, 1.0 / path.gain)
    poses[..., 2] = path.gain * np.sign(path.bearing) * turning
    return poses


def drifting(path: UnicycleTrajectory, times: Array, poses: Array) -> Array:
    """Leave the straight line slowly."""
    poses[..., 1] += 1e-3 * np.maximum(times - 1.0 / path.gain, 0.0)
    return poses


def clockwise(path: UnicycleTrajectory, _: Array, poses: Array) -> Array:
    """Rotate left-turning paths clockwise by 1 mrad."""
    if path.bearing < 0.0:
        return poses
    x, y = poses[..., 0].copy(), poses[..., 1].copy()
    poses[..., 0] += 1e-3 * y
    poses[..., 1] -= 1e-3 * x
    return poses


def all_left(steps: Array) -> Array:
    """Place the right feet on the left of the path."""
    steps[1::2, 0] -= 0.1 * np.sin(steps[1::2, 2])
    steps[1::2, 1] += 0.1 * np.cos(steps[1::2, 2])
    return steps


def anywhere(steps: Array) -> Array:
    return steps + np.random.default_rng(1).normal(0.0, 0.01, steps.shape)


def turned(by: float) -> Patch:
    return placed_as(lambda steps: steps + (0.0, 0.0, by))


def scaled(poses: Array, by: float) -> Array:
    """Scale positions, not headings."""
    return poses * (by, by, 1.0)


def as_at(end: float, poses: Array) -> Array:
    """Hold the first pose, scaled."""
    return np.repeat(poses[:1], len(poses), axis=0) * end


def aslant(times: Array, poses: Array, speed: float) -> Array:
    """Drift sideways at a speed, in [m/s]."""
    way = poses[-1, :2] - poses[0, :2]
    aside = np.array([-way[1], way[0]]) / np.hypot(*way)
    shift = speed * (times - times[0])[:, None] * aside
    return np.column_stack([poses[:, :2] + shift, poses[:, 2]])


FAULTS: dict[str, tuple[Patch, ...]] = {
    "circle.pursuer_radius": (
        seen_as(lambda g, t, p, e: (scaled(p, 1.01), e)),
        seen_as(lambda g, t, p, e: (scaled(p, 0.1), e)),
        seen_as(lambda g, t, p, e: (as_at(1.0, p), e)),
    ),
    "circle.evader_radius": (
        seen_as(lambda g, t, p, e: (p, scaled(e, 1.01))),
        seen_as(lambda g, t, p, e: (p, scaled(e, 0.1))),
    ),
    "circle.one_circle": (seen_as(lambda g, t, p, e: (p, e + 0.01)),),
    "circle.distance": (
        seen_as(lambda g, t, p, e: (p, scaled(e - p, 1.01) + p)),
        seen_as(lambda g, t, p, e: (p, scaled(e - p, 0.5) + p)),
    ),
    "circle.orientation": (
        seen_as(lambda g, t, p, e: (p, e + (0.0, 0.0, 0.01))),
        seen_as(lambda g, t, p, e: (p, e - (0.0, 0.0, 0.01))),
    ),
    "circle.pursuer_speed": (
        seen_as(lambda g, t, p, e: (scaled(p, 0.9), e)),
        seen_as(lambda g, t, p, e: (as_at(1.0, p), e)),
    ),
    "circle.same_speed": (
        seen_as(lambda g, t, p, e: (p, scaled(e, 0.9))),
        seen_as(lambda g, t, p, e: (p, as_at(1.0, e))),
    ),
    "saturated.radius": (
        played_as(lambda g: replace(g, law=theory_claims.FIG_2.law)),
        seen_as(lambda g, t, p, e: (p, scaled(e, 0.9))),
    ),
    "saturated.smaller": (
        played_as(lambda g: replace(g, law=theory_claims.FIG_2.law)),
    ),
    "saturated.less": (seen_as(lambda g, t, p, e: (p, e - (0.0, 0.0, 0.5))),),
    "saturated.namely": (
        seen_as(lambda g, t, p, e: (p, e + (0.0, 0.0, 0.01))),
        seen_as(lambda g, t, p, e: (p, e - (0.0, 0.0, 0.01))),
    ),
    "strategies.apart": (
        seen_as(lambda g, t, p, e: (p, e + (0.0, 0.0, 0.01))),
        seen_as(lambda g, t, p, e: (p, e - (0.0, 0.0, 0.01))),
    ),
    "strategies.grows": (
        played_as(lambda g: replace(g, angle=theory_claims.ANGLES[-1])),
        seen_as(lambda g, t, p, e: (p, scaled(e, exp(2.0 * g.angle)))),
    ),
    "strategies.unbounded": (
        seen_as(lambda g, t, p, e: (p, scaled(e, 1.01))),
        seen_as(lambda g, t, p, e: (p, scaled(e, 0.99))),
    ),
    "strategies.back": (
        seen_as(lambda g, t, p, e: (p, scaled(e, -1.0))),
        seen_as(lambda g, t, p, e: (p, as_at(1.0, e))),
        seen_as(lambda g, t, p, e: (p, e[:1] + 0.1 * (e - e[:1]))),
        seen_as(lambda g, t, p, e: (p, aslant(t, e, 0.01))),
        seen_as(lambda g, t, p, e: (p, aslant(t, e, -0.01))),
    ),
    "sampled.radius": (
        sampled_as(lambda p, e: (scaled(p, 1.01), e)),
        sampled_as(lambda p, e: (scaled(p, 0.5), e)),
    ),
    "sampled.distance": (
        sampled_as(lambda p, e: (p, scaled(e - p, 1.01) + p)),
        sampled_as(lambda p, e: (p, scaled(e - p, 0.5) + p)),
    ),
    "sampled.orientation": (
        sampled_as(lambda p, e: (p, e + (0.0, 0.0, 0.01))),
        sampled_as(lambda p, e: (p, e - (0.0, 0.0, 0.01))),
    ),
    "path.arc": (
        poses_as(one_side),
        poses_as(lambda path, t, p: scaled(p, 1.01)),
    ),
    "path.way": (
        poses_as(lambda path, t, p: 0.0 * p),
        poses_as(lambda path, t, p: scaled(p, 0.99)),
    ),
    "path.heading": (
        poses_as(printed_heading),
        poses_as(lambda path, t, p: p * (1.0, 1.0, -1.0)),
    ),
    "path.line": (
        poses_as(drifting),
        poses_as(clockwise),
        poses_as(lambda path, t, p: scaled(p, -1.0)),
        poses_as(lambda path, t, p: 0.0 * p),
    ),
    "footsteps.stepsize": (
        placed_as(lambda steps: steps, stride=2.0),
        placed_as(lambda steps: steps, stride=0.99),
        placed_as(anywhere),
    ),
    "footsteps.sides": (
        placed_as(all_left),
        placed_as(lambda steps: steps, foot_spacing=0.9),
        placed_as(anywhere),
    ),
    "footsteps.tangent": (turned(0.01), turned(-0.01), turned(np.pi)),
    "com.bounded": (
        samples_as(
            lambda s: s._replace(
                com=s.com + 1e-9 * np.exp(6.05 * s.times)[:, None]
            )
        ),
    ),
    "com.pendulum": (
        samples_as(lambda s: s._replace(com=s.zmp)),
        samples_as(lambda s: s._replace(com=1.01 * s.com)),
    ),
    "com.integral": (
        samples_as(lambda s: s._replace(dcm=s.dcm + 1e-5)),
        samples_as(lambda s: s._replace(dcm=s.com)),
    ),
    "com.reached": (turned(1e-6), turned(-1e-6)),
    "timing.planning": (slow_clock,),
}
CLAIMS = {
    f"{job}.{key}": claim
    for job in ONCE
    for key, claim in load_claims()[job].items()
}


def holds(name: str) -> bool:
    job, key = name.split(".")
    return CLAIMS[name].holds([ONCE[job]()[key]])


@cache
def measured(job: str) -> Mapping[str, Any]:
    """Values of the claims of one job, without a fault."""
    return ONCE[job]()


@pytest.mark.parametrize("name", CLAIMS)
def test_every_claim_holds_and_fails_under_a_fault(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    job, key = name.split(".")
    if name == "timing.planning":  # depends on the speed of the computer
        monkeypatch.setattr(theory_claims, "process_time", lambda: 0.0)
        assert holds(name)
    else:
        assert CLAIMS[name].holds([measured(job)[key]])
    for fault in FAULTS[name]:
        with monkeypatch.context() as patches:
            fault(patches)
            assert not holds(name)


def test_every_fault_has_a_claim() -> None:
    assert set(FAULTS) == set(CLAIMS)
    assert all(FAULTS.values())


def test_evader_with_the_opposite_turn_misses_the_circle(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def wrong(game: Unicycles) -> PlayedGame:
        return play(replace(game, angle=3.0 - game.angle))

    monkeypatch.setattr(theory_claims, "play", wrong)
    for key in ("pursuer_radius", "distance", "orientation"):
        assert not holds(f"circle.{key}")


def test_plans_cover_both_sides_and_both_directions(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    right, asked = ManeuverPlanner.plan, set()

    def spy(self: Any, bearing: float, direction: Direction, **k: Any) -> Any:
        asked.add((bearing > 0.0, direction))
        return right(self, bearing, direction, **k)

    monkeypatch.setattr(ManeuverPlanner, "plan", spy)
    ONCE["footsteps"]()
    assert len(asked) == 4
