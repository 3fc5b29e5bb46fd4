"""Campaigns of other walks: what is changed, and how hard they are pushed."""

from dataclasses import replace
from math import pi
from typing import Any

import pytest

from stepaside.games.robot_settings import RobotGameSettings
from stepaside.games.walk_settings import WalkSettings
from stepaside.locomotion.zmp.control_settings import (
    STABILISED,
    StabiliserSettings,
)
from stepaside.planning import GaitSettings
from stepaside.sim.body_settings import BODIES
from stepaside.sim.push import Push
from stepaside.studies import robustness_trial as robustness
from stepaside.studies import survival_statistics
from stepaside.studies.push_limits import push_cases
from stepaside.studies.robustness_trial import (
    RobustnessTrial,
    control_of,
    push_scale,
    push_time,
    settings_of,
    trials,
)
from stepaside.studies.settings_diff import changes_of
from stepaside.studies.survival_statistics import (
    foot_reach,
    limit_rows,
    push_bound_at,
    push_survival_rows,
)

GAIT = GaitSettings(stride=0.03, single_support=0.3)
GAINS = replace(StabiliserSettings(), ankle=0.2, reach_forward=0.05)
WALK = WalkSettings(
    seed=4,
    duration=7.0,
    bearing=0.1,
    gait=GAIT,
    body=replace(BODIES["hardware"], stiffness=0.8),
    control=replace(STABILISED, stabiliser=GAINS),
    pushes=(Push(1.0, 1.0, 0.0),),
)


def test_trials_walk_as_was_asked_but_for_the_disturbance() -> None:
    body, changes = changes_of(WALK)
    grid = trials(["friction"], ["mpc"], body, seeds=1, changes=changes)
    trial = next(grid)
    walk = settings_of(trial)
    assert walk.physics.friction == trial.strength
    assert (walk.gait, walk.body, walk.bearing) == (GAIT, WALK.body, 0.1)
    assert walk.control == control_of("mpc", WALK.control)
    assert walk.control.stabiliser == GAINS and walk.pushes == ()


def test_a_push_waits_for_the_phase_of_the_gait_that_is_walked() -> None:
    control = control_of("mpc")
    later = push_time(0.5, control, GAIT) - push_time(0.0, control, GAIT)
    assert later == pytest.approx(GAIT.step_duration)
    changes = changes_of(WALK)[1]
    trial = RobustnessTrial(
        "push", 1.0, "left", 0.5, 1, "mpc", "ideal", changes
    )
    [push] = settings_of(trial).pushes
    assert push.time == push_time(0.5, control, GAIT)


def heavier(monkeypatch: pytest.MonkeyPatch, factor: float) -> WalkSettings:
    """A robot like NAO but for its mass."""
    robustness.mass_of.cache_clear()
    usual = robustness.mass_of("nao")

    def mass_of(robot: str) -> float:
        return usual * (factor if robot == "heavy" else 1.0)

    monkeypatch.setattr(robustness, "mass_of", mass_of)
    monkeypatch.setattr(robustness, "load_robot", lambda name: name)
    monkeypatch.setattr(
        robustness, "game_settings_from_description", lambda robot: None
    )
    monkeypatch.setattr(survival_statistics, "mass_of", mass_of)
    push_bound_at.cache_clear()
    return WalkSettings(robot="heavy")


def test_robots_are_pushed_to_the_same_speeds_whatever_their_mass(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert push_scale("nao") == 1.0
    walk = heavier(monkeypatch, 4.0)
    assert push_scale("heavy") == 4.0
    trial = RobustnessTrial("push", 1.2, "left", 0.0, 1, "mpc", "ideal")
    pushed = [
        settings_of(replace(trial, changes=changes)).pushes[0]
        for changes in ("", changes_of(walk)[1])
    ]
    assert [push.impulse for push in pushed] == [1.2, pytest.approx(4.8)]
    assert {push.direction for push in pushed} == {pi / 2}


def test_robots_with_a_unit_of_pushes_are_pushed_by_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It goes with mass and pendulum, as the push that a capture bears."""
    units = {"nao": 1.0, "tall": 24.0}
    monkeypatch.setattr(robustness, "load_robot", lambda name: name)
    monkeypatch.setattr(
        robustness,
        "game_settings_from_description",
        lambda robot: RobotGameSettings(0.8, 0.4, 0.6, 1.5, units[robot]),
    )
    assert push_scale("tall") == 24.0


def test_limits_and_bounds_grow_with_the_mass_and_their_ratio_does_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    changes = changes_of(heavier(monkeypatch, 4.0))[1]
    rows: list[dict[str, Any]] = []
    for text in ("", changes):
        case = next(push_cases(["mpc"], "ideal", phases=1, changes=text))
        strengths = [0.4, 0.8, 0.6, 0.7]
        survived = [True, False, True, False]
        record = {"strengths": strengths, "survived": survived}
        rows += limit_rows([(case, record)])
    usual, heavy = rows
    assert usual["limit_n_s"] == 0.6
    for name in ("limit_n_s", "bound_n_s", "impulse_bound_n_s"):
        assert heavy[name] == pytest.approx(4.0 * usual[name])
    for name in ("limit_m_s", "ratio"):
        assert heavy[name] == pytest.approx(usual[name])
    counted = push_survival_rows([heavy], 4.0)
    assert [row["strength"] for row in counted[:2]] == [1.6, 3.2]
    assert [row["survived"] for row in counted[:2]] == [1, 0]


def test_bound_and_reach_are_those_of_the_walk_that_is_pushed() -> None:
    assert foot_reach(WALK).forward == 0.05
    usual = push_bound_at("forward", 0.3)
    assert push_bound_at("forward", 0.3, WALK) != pytest.approx(
        usual, rel=1e-3
    )
    low = replace(WalkSettings(), gait=replace(GAIT, com_height=0.2))
    assert push_bound_at("right", 0.0, low) != pytest.approx(
        push_bound_at("right", 0.0), rel=1e-3
    )
    back = replace(WalkSettings(), backward=True)
    assert push_bound_at("backward", 0.1, back) != pytest.approx(
        push_bound_at("backward", 0.1), rel=1e-3
    )
