"""Campaigns: what each trial asks for, and results that are not made twice."""

from collections.abc import Callable
from concurrent.futures import Executor, Future
from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.locomotion.zmp.control_settings import ControlSettings
from stepaside.planning import GaitSettings
from stepaside.sim.body_settings import BODIES
from stepaside.sim.physics_settings import PhysicsSettings
from stepaside.studies import (
    push_limits as limits,
)
from stepaside.studies import (
    robustness_campaign as robustness,
)
from stepaside.studies import (
    robustness_campaign as trial_results,
)
from stepaside.studies.code_version import code_version
from stepaside.studies.push_limits import (
    limit_of,
    next_strength,
    push_cases,
    search_limits,
)
from stepaside.studies.robustness_campaign import (
    DIRECTIONS,
    STRENGTHS,
    RobustnessTrial,
    control_of,
    push_time,
    run_campaign,
    settings_of,
    trials,
    with_noise,
)

TRIAL = RobustnessTrial("friction", 0.3, "", 0.0, 5, "measured", "hardware")
PUSH = RobustnessTrial("push", 1.2, "left", 0.25, 5, "closed-form", "ideal")


class Inline(Executor):
    """Runs at once, in this process."""

    def submit(
        self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any
    ) -> Future[Any]:
        """Run it."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except BaseException as error:
            future.set_exception(error)
        return future


def survives(
    monkeypatch: pytest.MonkeyPatch, rule: Callable[[RobustnessTrial], bool]
) -> list[RobustnessTrial]:
    """Replace walks by a rule; return those that were asked for."""
    asked: list[RobustnessTrial] = []

    def run(trial: RobustnessTrial) -> tuple[str, bool]:
        asked.append(trial)
        return trial.key, rule(trial)

    monkeypatch.setattr(robustness, "run_trial", run)
    monkeypatch.setattr(limits, "run_trial", run)
    return asked


def test_each_method_has_its_control() -> None:
    assert control_of("open-loop") == ControlSettings()
    for method in ("closed-form", "measured", "mpc"):
        control = control_of(method)
        assert (control.method, control.feedback) == (method, True)


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


@pytest.mark.parametrize("method", ["open-loop", "measured"])
def test_push_time_is_six_steps_after_the_start_and_the_phase(
    method: str,
) -> None:
    """A whole cycle is two steps; feedback stands for a second first."""
    gait, control = GaitSettings(), control_of(method)
    begins = gait.start_support + (1.0 if method == "measured" else 0.0)
    at = push_time(0.0, control)
    assert at == pytest.approx(begins + 6 * gait.step_duration)
    later = push_time(0.5, control) - at
    assert later == pytest.approx(gait.step_duration)


def test_an_unknown_kind_is_refused() -> None:
    with pytest.raises(ConfigurationError, match="kind must be .*'wind'"):
        settings_of(replace(TRIAL, kind="wind"))


def test_grid_has_each_strength_with_each_seed_and_no_pushes() -> None:
    grid = list(
        trials(
            ["push", "backlash", "noise"],
            ["mpc"],
            "ideal",
            seeds=3,
            first_seed=7,
        )
    )
    number = len(STRENGTHS["backlash"]) + len(STRENGTHS["noise"])
    assert len(grid) == 3 * number == len({trial.key for trial in grid})
    assert {trial.seed for trial in grid} == {7, 8, 9}
    assert {trial.kind for trial in grid} == {"backlash", "noise"}


def test_cases_cover_methods_directions_and_phases() -> None:
    cases = list(push_cases(["mpc", "measured"], "ideal", phases=4, seed=2))
    assert len(cases) == len(set(cases)) == 2 * len(DIRECTIONS) * 4
    assert {case.phase for case in cases} == {0.0, 0.25, 0.5, 0.75}
    assert {case.strength for case in cases} == {0.0}


def test_an_interrupted_campaign_continues(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    asked = survives(monkeypatch, lambda trial: trial.strength < 1.5)
    grid = list(trials(["backlash"], ["mpc"], "ideal", seeds=2))
    file, told = tmp_path / "trials.jsonl", list[int]()
    first = run_campaign(grid[:4], file, Inline())
    assert asked == grid[:4]
    with file.open("a") as out:
        out.write('["cut off')  # as by a power cut
    file.write_text(file.read_text() + "\n")
    both = run_campaign(grid, file, Inline(), told.append)
    assert asked == grid
    assert first.items() <= both.items() and len(both) == len(grid)
    assert told[0] == 4 and told[-1] == len(grid)
    assert [both[trial.key] for trial in grid] == [
        trial.strength < 1.5 for trial in grid
    ]
    assert run_campaign(grid, None, Inline()) == both


def test_results_of_other_code_are_made_again(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    asked = survives(monkeypatch, lambda trial: True)
    file = tmp_path / "trials.jsonl"
    run_campaign([TRIAL], file, Inline())
    run_campaign([TRIAL], file, Inline())
    assert len(asked) == 1
    monkeypatch.setattr(trial_results, "code_version", lambda rooms: "other")
    run_campaign([TRIAL], file, Inline())
    assert len(asked) == 2
    assert list(trial_results.read_results(file)) == [TRIAL.key]


@pytest.mark.parametrize(
    ("name", "other"),
    [
        ("library_versions", lambda: {"mujoco": "0", "numpy": "0"}),
        (
            "code_version",
            lambda rooms: (
                "edited"
                if "studies/robustness_campaign" in rooms
                else code_version(rooms)
            ),
        ),
    ],
)
def test_libraries_and_walk_modules_invalidate_a_result(
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    name: str,
    other: Callable[..., object],
) -> None:
    file = tmp_path / "trials.jsonl"
    trial_results.append_result(file, TRIAL.key, True)
    assert trial_results.read_results(file) == {TRIAL.key: True}
    monkeypatch.setattr(trial_results, name, other, raising=False)
    assert trial_results.read_results(file) == {}
    trial_results.append_result(file, TRIAL.key, False)
    assert trial_results.read_results(file) == {TRIAL.key: False}


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
    file, told = tmp_path / "trials.jsonl", list[int]()
    found = search_limits(cases, file, Inline(), told.append)
    for case, outcomes in limits.outcomes_of(cases, found).items():
        limit = truth[case.direction]
        assert limit - 0.1 < limit_of(outcomes) <= limit + 1e-9
    assert told[-1] == len(cases)
    number = len(asked)
    assert number == len(found) < 8 * len(cases)
    assert search_limits(cases, file, Inline()) == found
    assert len(asked) == number  # nothing was walked again


def test_a_search_gives_back_what_it_was_asked_for_alone(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """One folder holds other methods, seeds and kinds beside it."""
    survives(monkeypatch, lambda t: t.strength < 1.0)
    file = tmp_path / "trials.jsonl"
    cases = list(push_cases(["mpc"], "ideal", phases=1))
    alone = search_limits(cases, None, Inline())
    search_limits(
        [
            *push_cases(["measured"], "ideal", phases=1),
            *push_cases(["mpc"], "ideal", phases=2, seed=2),
        ],
        file,
        Inline(),
    )
    run_campaign([TRIAL], file, Inline())
    assert search_limits(cases, file, Inline()) == alone
    assert search_limits(cases, file, Inline()) == alone
    done = {TRIAL.key: True}
    found = search_limits(cases, file, Inline(), None, done)
    assert found == alone | {TRIAL.key: True}


def test_a_search_that_was_stopped_ends_as_one_that_was_not(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    cases = list(push_cases(["mpc"], "ideal", phases=2))
    survives(monkeypatch, lambda t: t.strength < 1.0 + t.phase)
    whole = search_limits(cases, None, Inline())
    file = tmp_path / "trials.jsonl"

    def fails(trial: RobustnessTrial) -> bool:
        if trial.strength > 0.9:
            raise KeyboardInterrupt
        return trial.strength < 1.0 + trial.phase

    survives(monkeypatch, fails)
    partly: dict[str, bool] = {}
    with pytest.raises(KeyboardInterrupt):
        search_limits(cases, file, Inline(), None, partly)
    assert 0 < len(partly) < len(whole) and partly.items() <= whole.items()
    survives(monkeypatch, lambda t: t.strength < 1.0 + t.phase)
    assert search_limits(cases, file, Inline()) == whole
