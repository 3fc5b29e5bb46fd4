"""Test the measurement of learned legs."""

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("onnxruntime")

from legs_robot import nao_on_legs
from stepaside.core.errors import PolicyError
from stepaside.fitting.legs_measurement import (
    LegsTrial,
    LegsTrialResult,
    measure_legs,
    run_tracking_walk,
    run_trial,
)
from stepaside.games.player_settings import settings_from_description
from stepaside.robots.description import RobotDescription, load_robot
from stepaside.sim.body_settings import BodySettings
from stepaside.strategies.body_departure import BodyDeparture
from stepaside.strategies.velocity_set import STILL, BodyVelocity

# Delivered velocity by commanded one.
GAINS = np.array([[0.8, 0.0, 0.02], [0.01, 0.5, 0.0], [0.0, -0.03, 0.9]])


class FormulaExecutor(Executor):
    """Executor that computes the result of each trial by a formula."""

    def __init__(self, falls: Callable[[BodyVelocity], bool]) -> None:
        self._falls = falls

    def map(  # type: ignore[override]
        self, fn: Callable[..., Any], trials: Iterable[LegsTrial], **_: Any
    ) -> Iterator[LegsTrialResult | BodyDeparture]:
        """Deliver velocities that are linear in the command."""
        for trial in trials:
            if fn is run_tracking_walk:
                yield BodyDeparture(0.4, 0.1 * trial.seed, 0.01, 0.002)
                continue
            delivered = BodyVelocity(*(GAINS @ np.array(trial.command)))
            fell = 2.0 if self._falls(trial.command) else None
            seen = (delivered.forward / 1.05, delivered.lateral / 1.1)
            lag, halting = (
                (0.4, 0.25) if min(trial.command) < 0 else (0.2, 0.1)
            )
            yield LegsTrialResult(
                trial.command, delivered, lag, halting, fell, seen
            )


def never(command: BodyVelocity) -> bool:
    return False


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> RobotDescription:
    return load_robot(nao_on_legs(tmp_path_factory.mktemp("legs") / "nao"))


def measured(
    robot: RobotDescription, falls: Callable[[BodyVelocity], bool] = never
) -> Any:
    done: list[tuple[int, int]] = []
    result = measure_legs(
        robot,
        settings_from_description(robot).legs,
        BodySettings(),
        FormulaExecutor(falls),
        lambda count, of: done.append((count, of)),
    )
    assert done[-1] == (28, 28)
    return result


def test_linear_legs_are_measured_exactly(robot: RobotDescription) -> None:
    result = measured(robot)
    np.testing.assert_allclose(result.gains(), GAINS, atol=1e-12)
    assert result.response.odometry_ratio == pytest.approx((1.05, 1.1))
    wanted, command = np.array([0.4, 0.1, -0.3]), np.zeros(3)
    result.response.inverse(wanted, command)()
    found = result.response.deliver(BodyVelocity(*command))
    assert found == pytest.approx(wanted)
    legs = result.response.velocities  # of the mean lag, and the worst halt
    assert legs.lags == pytest.approx([0.3] * 3)
    assert legs.halting == (0.25,) * 3
    assert result.response.velocities.tube == pytest.approx(0.3)  # the widest


def test_commands_that_led_to_a_fall_are_left_out(
    robot: RobotDescription,
) -> None:
    """And those beyond them, on that side of the axis."""
    result = measured(robot, lambda command: command.forward == 0.5)
    assert result.falls == 1
    assert result.response.axes[0].commands == (
        -1.0,
        -0.75,
        -0.5,
        -0.25,
        0,
        0.25,
    )
    assert result.response.velocities.forward == pytest.approx((-0.8, 0.2))


def test_legs_that_fall_while_standing_are_refused(
    robot: RobotDescription,
) -> None:
    with pytest.raises(PolicyError, match="fell at 2.00 s while it was to"):
        measured(robot, lambda command: command == STILL)


def test_a_robot_that_holds_a_posture_delivers_nothing(
    robot: RobotDescription,
) -> None:
    legs = settings_from_description(robot).legs
    trial = LegsTrial(robot, legs, BodySettings(), 1, BodyVelocity(0.5))
    result = run_trial(trial)
    assert result.fell_at is None
    assert result.delivered == pytest.approx((0.0, 0.0, 0.0), abs=2e-3)
    assert result.odometry == pytest.approx((0.0, 0.0), abs=2e-3)


def test_a_fall_ends_a_trial(tmp_path: Path) -> None:
    robot = load_robot(nao_on_legs(tmp_path / "nao", gain=1.0))
    legs = settings_from_description(robot).legs
    trial = LegsTrial(robot, legs, BodySettings(), 1, BodyVelocity(0.9))
    result = run_trial(trial)
    assert result.fell_at is not None and 1.5 < result.fell_at < 4.0
    assert np.isnan(result.delivered).all()
