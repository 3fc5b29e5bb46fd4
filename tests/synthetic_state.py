"""Feedback of a robot in a prescribed state."""

from typing import Any

import numpy as np

from stepaside.core.poses import Pose
from stepaside.locomotion.control_settings import (
    ControlSettings,
    StabiliserSettings,
)
from stepaside.locomotion.locomotion import CurrentStep
from stepaside.locomotion.zmp.reference_table import ReferenceSample
from stepaside.locomotion.zmp.stabiliser import Stabiliser
from stepaside.locomotion.zmp.state_estimator import BodyState
from stepaside.perception.measurement import RobotState
from stepaside.planning import Foot, GaitSettings
from stepaside.robots.leg_kinematics import BodyReference

GAIT = GaitSettings()


ETA, TICK = GAIT.eta, 0.004


GAINS = StabiliserSettings()


SUPPORT = Pose(1.0, -2.0, 0.7)


ZERO = (0.0, 0.0)


MEASUREMENT = RobotState(
    0.0, np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(8), None
)


COM, DCM, ZMP = (1.0, -1.95), (1.02, -1.94), (0.99, -1.96)


BODY = BodyReference(
    (*COM, 0.27), (0.1, 0.2, 0.01, 0.3), (0.4, 0.5, 0.02, 0.6)
)


ROW = ReferenceSample(BODY, ZMP, DCM, Pose(0.0, 0.0, 0.0))


class FakeEstimator:
    """States as they are wanted; notes what it is told."""

    def __init__(self) -> None:
        self.ready = True
        self.torso_heading = 0.0
        self.off_com = self.off_dcm = self.tilt = ZERO
        self.left_share = 0.5
        self.told: list[tuple[BodyReference, tuple[float, float]]] = []
        self.reactions: list[tuple[float, float]] = []

    def update(
        self,
        measurement: RobotState,
        feet: BodyReference,
        asked: Any,
        reaction: tuple[float, float],
    ) -> BodyState:
        """Note what is told, and answer with a state."""
        self.told.append((feet, asked))
        self.reactions.append(reaction)
        (cx, cy), (dx, dy) = self.off_com, self.off_dcm
        return BodyState(
            (COM[0] + cx, COM[1] + cy),
            ZERO,
            (DCM[0] + dx, DCM[1] + dy),
            ZMP,
            self.tilt,
            (0.0, 0.0, 0.0),
            self.left_share,
            50.0,
        )


def stabiliser(
    method: str = "measured", gains: StabiliserSettings = GAINS, **changes: Any
) -> tuple[Stabiliser, FakeEstimator]:
    fake: Any = FakeEstimator()
    settings = ControlSettings(method, True, gains)  # type: ignore[arg-type]
    legs: Any = None
    made = Stabiliser(settings, fake, GAIT, legs, tick=TICK, **changes)
    return made, fake


def step(**changes: Any) -> CurrentStep:
    landing = SUPPORT.compose(Pose(0.04, 0.1, 0.0))
    values: dict[str, Any] = {
        "support": SUPPORT,
        "swing": Foot.LEFT,
        "landing": landing,
        "remaining": 0.2,
        "progress": 0.5,
        "walking": True,
    } | changes
    return CurrentStep(**values)


def same(one: Any, other: Any) -> None:
    np.testing.assert_allclose(one, other, atol=1e-12)
