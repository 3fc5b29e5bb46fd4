"""Test the validation of control settings."""

from dataclasses import asdict, fields

import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.locomotion.zmp.control_settings import (
    OPEN_LOOP,
    STABILISED,
    ControlSettings,
    MpcSettings,
    StabiliserSettings,
)

GAINS = [f.name for f in fields(StabiliserSettings)]


def test_gains_are_those_that_the_documents_were_measured_with() -> None:
    """A changed value requires new tables in docs/walking.md."""
    assert asdict(StabiliserSettings()) == {
        "dead_zone": 0.015,
        "yielding": 5.0,
        "feedback": 4.0,
        "ankle": 0.3,
        "ankle_rate": 0.03,
        "ankle_bandwidth": 50.0,
        "edge": 0.002,
        "reach_forward": 0.08,
        "reach_backward": 0.08,
        "reach_outward": 0.02,
        "gap": 0.012,
        "step_speed": 1.5,
        "freeze": 0.95,
        "stride_gain": 0.3,
        "stride_bound": 0.015,
        "joint_gain": 10.0,
        "joint_bound": 0.03,
        "joint_leak": 1.0,
        "load_share": 0.0,
    }
    assert asdict(MpcSettings()) == {
        "steps": 2,
        "samples": 10,
        "tail": "anticipative",
        "pull": 100.0,
    }


def test_the_paper_walks_without_feedback() -> None:
    assert OPEN_LOOP == ControlSettings("closed-form", False)
    assert STABILISED == ControlSettings("measured", True)


@pytest.mark.parametrize("value", [-0.1, float("nan"), float("inf")])
@pytest.mark.parametrize("name", GAINS)
def test_invalid_gains_are_refused(name: str, value: float) -> None:
    with pytest.raises(ConfigurationError, match=f"{name}.* must"):
        StabiliserSettings(**{name: value})


@pytest.mark.parametrize("name", sorted({*GAINS} - {"feedback", "freeze"}))
def test_zero_gains_are_valid(name: str) -> None:
    assert asdict(StabiliserSettings(**{name: 0.0}))[name] == 0.0


@pytest.mark.parametrize("gain", [0.0, 0.9, 1.0])
def test_a_feedback_gain_of_one_is_refused(gain: float) -> None:
    with pytest.raises(
        ConfigurationError, match=r"feedback must .*\(1, 100\]"
    ):
        StabiliserSettings(feedback=gain)
    assert StabiliserSettings(feedback=1.01).feedback == 1.01


def test_fractions_lie_between_0_and_1() -> None:
    for whole in (0.0, 1.0):
        assert StabiliserSettings(freeze=whole).freeze == whole
    with pytest.raises(ConfigurationError, match="freeze"):
        StabiliserSettings(freeze=1.01)


@pytest.mark.parametrize(
    ("name", "low", "high"), [("steps", 1, 10), ("samples", 2, 100)]
)
def test_horizons_have_limits(name: str, low: int, high: int) -> None:
    for value in (low, high):
        assert asdict(MpcSettings(**{name: value}))[name] == value  # type: ignore[arg-type]
    for value in (low - 1, high + 1):
        with pytest.raises(ConfigurationError, match=f"mpc.{name}"):
            MpcSettings(**{name: value})  # type: ignore[arg-type]


def test_invalid_mpc_settings_are_refused() -> None:
    with pytest.raises(ConfigurationError, match="mpc.pull"):
        MpcSettings(pull=0.0)


def test_unknown_names_are_refused_with_the_known_ones() -> None:
    with pytest.raises(ConfigurationError, match="anticipative, periodic"):
        MpcSettings(tail="curly")  # type: ignore[arg-type]
    with pytest.raises(ConfigurationError, match="closed-form, measured"):
        ControlSettings(method="guess")  # type: ignore[arg-type]


@pytest.mark.parametrize("method", ["measured", "mpc"])
def test_a_measured_state_needs_feedback(method: str) -> None:
    with pytest.raises(ConfigurationError, match="needs feedback = true"):
        ControlSettings(method, False)  # type: ignore[arg-type]
    settings = ControlSettings(method=method, feedback=True)  # type: ignore[arg-type]
    assert settings.method == method
    with pytest.raises(ConfigurationError, match="true or false, got 1"):
        ControlSettings(feedback=1)  # type: ignore[arg-type]
