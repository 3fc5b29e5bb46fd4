"""Campaigns: what each trial asks for, and results that are not made twice."""

from collections.abc import Callable
from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import pytest

from stepaside.sim.body_settings import BODIES
from stepaside.sim.physics_settings import PhysicsSettings
from stepaside.studies import push_limits as limits
from stepaside.studies import robustness_campaign as robustness
from stepaside.studies.push_limits import (
    limit_of,
    next_strength,
    outcomes_of,
    push_cases,
)
from stepaside.studies.robustness_campaign import push_study
from stepaside.studies.robustness_trial import (
    RobustnessTrial,
    control_of,
    push_time,
    settings_of,
    with_noise,
)
from stepaside.studies.study import run_study

TRIAL = RobustnessTrial("friction", 0.3, "", 0.0, 5, "measured", "hardware")
PUSH = RobustnessTrial("push", 1.2, "left", 0.25, 5, "closed-form", "ideal")


def survives(
    monkeypatch: pytest.MonkeyPatch, rule: Callable[[RobustnessTrial], bool]
) -> list[RobustnessTrial]:
    """Replace walks by a rule; return those that were asked for."""
    asked: list[RobustnessTrial] = []

    def run(trial: RobustnessTrial) -> dict[str, Any]:
        asked.append(trial)
        return {"survived": rule(trial)}

    monkeypatch.setattr(robustness, "run_trial", run)
    monkeypatch.setattr(limits, "run_trial", run)
    return asked


def test_each_kind_changes_what_it_is_named_after_and_nothing_else() -> None:
    hardware, physics = BODIES["hardware"], PhysicsSettings()
    for kind, x, body, floor in (
        ("friction", 0.3, {}, {"friction": 0.3}),
        ("unevenness", 0.005, {}, {"unevenness": 0.005}),
        (
            "delay",
            4.0,
            {"cycle": 0.012, "delay_cycles": 4, "imu_delay_cycles": 1},
            {},
        ),
        ("backlash", 2.0, {"backlash": pi / 90.0}, {}),
        ("model", 0.06, {"mass_error": 0.06, "com_error": 0.006}, {}),
    ):
        walk = settings_of(replace(TRIAL, kind=kind, strength=x))
        wanted: Any = replace(hardware, **body)  # type: ignore[arg-type]
        assert walk.body == wanted
        assert walk.physics == replace(physics, **floor)  # type: ignore[arg-type]
        assert (walk.seed, walk.duration, walk.pushes) == (5, 20.0, ())
        assert walk.control == control_of("measured")


def test_noise_is_a_multiple_of_the_hardwares_on_any_body() -> None:
    walk = settings_of(
        replace(TRIAL, kind="noise", strength=2.0, body="ideal")
    )
    hardware, ideal = BODIES["hardware"], BODIES["ideal"]
    assert walk.body.gyro_noise == 2.0 * hardware.gyro_noise
    assert walk.body.force_gain_error == 2.0 * hardware.force_gain_error
    assert walk.body.backlash == ideal.backlash
    silent = with_noise(hardware, 0.0)
    assert silent.accelerometer_bias == silent.gyro_bias == 0.0


def test_a_push_comes_at_its_phase_of_a_walk_under_way() -> None:
    walk = settings_of(PUSH)
    [push] = walk.pushes
    assert (push.impulse, push.direction) == (1.2, pi / 2.0)
    assert push.time == push_time(0.25, walk.control)
    assert walk.duration == push.time + 4.0


@pytest.mark.parametrize(
    ("outcomes", "limit", "following"),
    [
        ({}, 0.0, 0.4),
        ({0.4: True}, 0.4, 0.8),
        ({0.4: False}, 0.0, 0.2),
        ({0.4: False, 0.2: True}, 0.2, 0.3),
        ({0.4: False, 0.2: False}, 0.0, 0.1),
        ({0.4: False, 0.2: False, 0.1: False}, 0.0, None),
        ({0.4: True, 0.8: True, 1.2: False, 1.0: False}, 0.8, 0.9),
        ({0.8: True, 1.2: False, 1.0: False, 0.9: True}, 0.9, None),
        ({0.4: True, 0.8: False, 1.2: True}, 0.4, 0.6),  # not monotone
        ({8.0: True}, 8.0, None),
    ],
)
def test_search_halves_the_gap_below_the_first_failure(
    outcomes: dict[float, bool], limit: float, following: float | None
) -> None:
    assert limit_of(outcomes) == limit
    assert next_strength(outcomes) == following


def test_search_finds_every_limit_to_a_tenth_with_few_walks(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    truth = {"left": 0.73, "right": 1.31, "forward": 2.0, "backward": 0.05}
    asked = survives(
        monkeypatch, lambda t: t.strength <= truth[t.direction] + 1e-9
    )
    cases = list(push_cases(["mpc"], "ideal", phases=1))
    store = tmp_path / "kept.sqlite"
    found = run_study(push_study(cases), store)
    for case, record in found.items():
        limit = truth[case.direction]
        assert limit - 0.1 < limit_of(outcomes_of(record)) <= limit + 1e-9
    number = len(asked)
    assert number < 8 * len(cases)
    again = run_study(push_study(cases), store)
    assert list(again.records()) == list(found.records())
    assert len(asked) == number  # nothing was walked again
