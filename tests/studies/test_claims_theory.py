"""Test readings of claims on unicycles and plans: as stored, and if skewed.

Every claim holds; where poses, footsteps and samples are a little wrong, each
reading is another one, which is stored in ``tests/data/claims.json``.
"""

from collections.abc import Callable
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.planning import Direction, ManeuverPlan, ManeuverPlanner
from stepaside.planning import maneuver as planner
from stepaside.planning.path import UnicycleTrajectory, place_footsteps
from stepaside.studies import theory_claims
from stepaside.studies.claims import ONCE, load_claims
from stepaside.studies.tournament import StrategyTrack, record_steps
from stepaside.theory.unicycle.unicycle_game import Unicycles
from stored_values import compare_stored

MAY_HOLD = {
    "strategies.grows",
    "saturated.less",
    "saturated.smaller",
}  # though all is skewed


@cache
def sampled() -> StrategyTrack:
    start = theory_claims.NAO_START.poses()
    return record_steps(theory_claims.SAMPLED.started_at(start))


def skewed(poses: Array, by: float = 1.0) -> Array:
    """Poses that are a little aside, turned and too far apart."""
    slope = 0.02 * by * np.linspace(0.0, 1.0, len(poses))
    x, y, theta = np.moveaxis(poses, -1, 0)
    grown = slope.reshape(-1, *[1] * (x.ndim - 1)) + 1.0
    return np.stack(
        [grown * x + 0.01 * by, 0.97 * y - 0.03 * by * x, theta + 0.02 * by],
        axis=-1,
    )


def wrong_play(game: Unicycles) -> Any:
    run = theory_claims_play(game)

    def poses(times: Any) -> tuple[Array, Array]:
        pursuer, evader = run.poses(times)
        return skewed(pursuer), skewed(evader, -2.0)

    return SimpleNamespace(
        game=game, end_time=run.end_time, circle=run.circle, poses=poses
    )


theory_claims_play = cache(theory_claims.play)


def skew(monkeypatch: pytest.MonkeyPatch) -> None:
    """Falsify all that is read."""
    poses: Callable[..., Array] = UnicycleTrajectory.poses
    sample: Callable[..., Any] = ManeuverPlan.sample

    def wrong_steps(*_: Any) -> Any:
        run = sampled()
        pursuer, evader = skewed(run.pursuer), skewed(run.evader, -2.0)
        return run._replace(pursuer=pursuer, evader=evader)

    def wrong_poses(self: UnicycleTrajectory, times: Any) -> Array:
        found = poses(self, np.asarray(times, dtype=np.float64))
        return found * (1.03, 0.95, 1.02)

    def wrong_places(path: UnicycleTrajectory, **more: Any) -> Array:
        steps = place_footsteps(path, **more | {"stride": 0.037})
        return steps * (1.0, 1.05, 1.03)

    def wrong_samples(self: ManeuverPlan, times: Any) -> Any:
        found = sample(self, times)
        com = 1.02 * found.com + 1e-3 * np.exp(found.times)[:, None]
        return found._replace(com=com, dcm=found.dcm + 1e-4)

    monkeypatch.setattr(theory_claims, "play", wrong_play)
    monkeypatch.setattr(theory_claims, "record_steps", wrong_steps)
    monkeypatch.setattr(UnicycleTrajectory, "poses", wrong_poses)
    monkeypatch.setattr(planner, "place_footsteps", wrong_places)
    monkeypatch.setattr(ManeuverPlan, "sample", wrong_samples)


@pytest.mark.parametrize("state", ["right", "skewed"])
@pytest.mark.parametrize("job", ONCE)
def test_claims_hold_unless_what_they_read_is_wrong(
    job: str, state: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    step = 0.02 if state == "skewed" else 0.0  # between readings of the clock
    clock = iter(np.arange(1e6) * step)
    monkeypatch.setattr(theory_claims, "process_time", lambda: next(clock))
    monkeypatch.setattr(theory_claims, "play", theory_claims_play)
    monkeypatch.setattr(theory_claims, "record_steps", lambda *_: sampled())
    if state == "skewed":
        skew(monkeypatch)
    found = ONCE[job]()
    claims = load_claims()[job]
    assert found.keys() == claims.keys()
    for key, claim in claims.items():
        if state == "right":
            assert claim.holds([found[key]]), key
        elif f"{job}.{key}" not in MAY_HOLD:
            assert not claim.holds([found[key]]), key
    compare_stored(
        "claims.json", f"{job}, {state}", map(float, found.values()), 1e-4
    )


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
