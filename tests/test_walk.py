"""Walks: estimation, feedback, pushes, on ideal and on honest bodies."""

import json
from math import pi

import numpy as np
import pytest
from click.testing import CliRunner

from stepaside.cli import main
from stepaside.control.settings import OPEN_LOOP, STABILISED
from stepaside.planning import GaitSettings
from stepaside.simulation.body_settings import BODIES
from stepaside.simulation.push import Push
from stepaside.simulation.settings import PhysicsSettings
from stepaside.simulation.walk import WalkSettings, run_walk
from stepaside.simulation.walk_summary import summarise_walk

GAIT = GaitSettings()
CYCLE = 2.0 * GAIT.step_duration


def pushed(
    impulse: float, direction: float, phase: float, *, feedback: bool
) -> bool:
    """Whether a straight walk survives a push at a phase of its cycle."""
    begins = GAIT.start_support + (1.0 if feedback else 0.0)
    time = begins + (3.0 + phase) * CYCLE
    control = STABILISED if feedback else OPEN_LOOP
    settings = WalkSettings(
        duration=time + 4.0,
        control=control,
        pushes=(Push(impulse, time, direction),),
    )
    return run_walk(settings, record=False).outcome == "completed"


def test_estimates_are_true_on_an_ideal_body() -> None:
    result = run_walk(
        WalkSettings(duration=12.0, bearing=0.5, control=STABILISED)
    )
    errors = summarise_walk(result)["estimation"]
    for name in ("com_x_m", "com_y_m"):
        assert errors[name]["rms"] < 0.002
    for name in ("velocity_x_m_s", "velocity_y_m_s"):
        assert errors[name]["rms"] < 0.015
    for name in ("roll_rad", "pitch_rad"):
        assert errors[name]["rms"] < 0.006


def test_estimates_hold_on_a_hardware_like_body() -> None:
    result = run_walk(
        WalkSettings(
            duration=15.0, body=BODIES["hardware"], control=STABILISED
        )
    )
    summary = summarise_walk(result)
    assert summary["outcome"] == "completed"
    errors = summary["estimation"]
    assert max(errors[f"com_{axis}_m"]["rms"] for axis in "xy") < 0.006
    assert summary["speed_ratio"] == pytest.approx(1.0, abs=0.05)
    assert summary["slip_per_step_m"] < 0.002


@pytest.mark.parametrize("backward", [False, True])
def test_turning_on_hardware_is_as_planned(backward: bool) -> None:
    result = run_walk(
        WalkSettings(
            duration=20.0,
            bearing=-0.6,
            backward=backward,
            body=BODIES["hardware"],
            control=STABILISED,
        )
    )
    summary = summarise_walk(result)
    assert summary["yaw_ratio"] == pytest.approx(1.0, abs=0.05)


def test_without_feedback_a_hardware_like_body_falls() -> None:
    """So that the other tests show what feedback does."""
    settings = WalkSettings(duration=20.0, body=BODIES["hardware"])
    assert run_walk(settings, record=False).outcome == "fall"


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("phase", [0.0, 0.25, 0.5, 0.75])
def test_feedback_survives_sideways_pushes(side: float, phase: float) -> None:
    assert pushed(1.2, side * pi / 2, phase, feedback=True)


def test_the_same_pushes_fell_the_open_loop() -> None:
    survived = [
        pushed(1.2, pi / 2, phase, feedback=False)
        for phase in (0.0, 0.25, 0.5, 0.75)
    ]
    assert not all(survived)


@pytest.mark.parametrize("direction", [0.0, pi])
def test_feedback_steps_out_of_a_push_along_the_walk(direction: float) -> None:
    time = 1.0 + GAIT.start_support + 3.0 * CYCLE
    result = run_walk(
        WalkSettings(
            duration=time + 4.0,
            control=STABILISED,
            pushes=(Push(2.4, time, direction),),
        )
    )
    assert result.outcome == "completed"
    assert result.adapted >= 1


def test_a_walk_is_repeated_bit_by_bit() -> None:
    settings = WalkSettings(
        seed=5,
        duration=6.0,
        body=BODIES["hardware"],
        control=STABILISED,
        physics=PhysicsSettings(unevenness=0.003),
    )
    first, second = run_walk(settings), run_walk(settings)
    for name, values in first.arrays.items():
        np.testing.assert_array_equal(values, second.arrays[name])


def run(*arguments: str) -> tuple[int, str, str]:
    result = CliRunner().invoke(main, ["walk", *arguments])
    return result.exit_code, result.stdout, result.stderr


def test_walk_prints_what_it_measured() -> None:
    code, out, _ = run(
        *("--body", "hardware", "--duration", "8", "--json"),
        *("--push", "0.5@5:90deg", "--push", "0.3@6:0"),
    )
    summary = json.loads(out)
    assert code == 0 and summary["outcome"] == "completed"
    assert summary["feedback"] and summary["method"] == "measured"
    x, y = summary["push_impulse_n_s"]
    assert x == pytest.approx(0.3, abs=0.05)
    assert y == pytest.approx(0.5, abs=0.05)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--push", "1@2"), "IMPULSE@TIME:DIRECTION"),
        (("--push", "x@2:0"), "impulse must be a finite number [N s]"),
        (("--push", "-1@2:0"), "push impulse must be finite and >= 0"),
        (("--method", "measured", "--open-loop"), "needs feedback"),
        (("--friction", "0"), "must be finite and > 0"),
        (("--slope", "50deg"), "slope must lie in"),
    ],
)
def test_walk_refuses_in_one_line(
    arguments: tuple[str, ...], message: str
) -> None:
    code, out, err = run(*arguments)
    assert code == 2 and out == ""
    assert message in err and err.count("\n") == 1
