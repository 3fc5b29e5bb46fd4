"""Test that the memory of a control scheme is bounded."""

from typing import Any

import numpy as np
import pytest

from fake_robot import GAIT, STEP, TICK, FakeStrategy, Run, measure
from memory_size import reachable_values
from stepaside.locomotion.walk_snapshots import Phase
from stepaside.locomotion.zmp.control_settings import (
    ControlSettings,
    MpcSettings,
)
from stepaside.locomotion.zmp.feedback_loop import ClosedLoop
from stepaside.locomotion.zmp.stabiliser import Stabiliser
from stepaside.robots.leg_kinematics import BodyReference, LegStates
from synthetic_state import FakeEstimator

# Four steps are a whole number of ticks: then the gait repeats on its clock.
AGAIN = round(4 * STEP / TICK)


class DullLegs:
    """Legs that reach everything and remember nothing."""

    torso_heading = 0.0

    def stand(self, reference: BodyReference) -> Any:
        """Take any posture."""
        return np.array(reference.com)

    track = stand

    def track_rows(self, references: Any) -> LegStates:
        """Follow the first."""
        return LegStates(np.zeros((2, 6)), references[:1, :3])


class Dull(FakeStrategy):
    """Heads to one side, and remembers nothing."""

    def decide(self, knowledge: Any, memory: Any) -> Any:
        """Turn a little."""
        intent, _ = super().decide(knowledge, memory)
        return intent, memory


class DullEstimator(FakeEstimator):
    """Finds every state off by the same, and notes nothing."""

    torso_heading = 0.0

    def update(
        self, measurement: Any, feet: Any, asked: Any, reaction: Any
    ) -> Any:
        """Answer with a state."""
        state = super().update(measurement, feet, asked, reaction)
        self.told.clear()
        self.reactions.clear()
        x, y, _ = feet.com
        dx, dy = self.off_dcm
        return state._replace(com=(x, y), dcm=(x + dx, y + dy))


class DullJoints:
    """Joints that miss nothing."""

    def update(self, angles: Any, targets: Any) -> Any:
        """Pass the targets on."""
        return targets


def dull(**changes: Any) -> Run:
    return Run(Dull(heading=0.5), legs=DullLegs(), **changes)


def weights(run: Run, rounds: int, times: int = 4) -> list[int]:
    """Sizes of the control's memory, at one phase of the gait each time."""
    found = []
    for _ in range(times + 1):
        for _ in range(rounds * AGAIN):
            run.scheme.update(measure(run.ticks * TICK))
            run.ticks += 1
        found.append(reachable_values(run.scheme))
    assert run.phase() is Phase.WALKING
    return found[1:]  # first the memories fill


def test_memory_is_constant_over_twenty_thousand_ticks() -> None:
    run = dull()
    found = weights(run, rounds=8)
    assert run.ticks > 20_000
    assert found[0] > 1000 and len(set(found)) == 1
    assert reachable_values([run.scheme, 1.0]) == found[0] + 2


@pytest.mark.parametrize("method", ["closed-form", "measured", "mpc"])
def test_feedback_memory_is_constant(method: Any) -> None:
    if method == "mpc":
        pytest.importorskip("daqp")
    estimator: Any = DullEstimator()
    estimator.off_dcm = (0.05, 0.0)  # far beyond the dead zone
    settings = ControlSettings(method, True, mpc=MpcSettings(steps=2))
    stabiliser = Stabiliser(
        settings, estimator, GAIT, tick=TICK, delay=3 * TICK
    )
    stabiliser.joints = DullJoints()  # type: ignore[assignment]
    run = dull(balance=lambda legs: ClosedLoop(stabiliser, legs))
    found = weights(run, rounds=1, times=2)
    assert (run.scheme.state.solved is not None) is (method == "mpc")
    assert run.scheme.state.adapted > 0
    # Shifts that are none share one object: a few values come and go.
    assert max(found) - min(found) < AGAIN / 10
