"""How a robot controls its walk."""

from dataclasses import dataclass, field
from typing import Literal, get_args

from ...errors import (
    ConfigurationError,
    check_not_negative,
    check_positive,
    check_within,
)

ERROR = ConfigurationError
Method = Literal["closed-form", "measured", "mpc"]
METHODS: tuple[str, ...] = get_args(Method)
Tail = Literal["anticipative", "periodic", "truncated"]
TAILS: tuple[str, ...] = get_args(Tail)


@dataclass(frozen=True, slots=True)
class StabiliserSettings:
    """Gains and limits of the feedback.

    They were found by trying pushes of both bodies; see ``docs/walking.md``.

    Attributes:
        dead_zone: Error of the DCM that is left to the stiff joints, in [m].
        yielding: Rate at which the reference gives way to an error beyond
            it, in [1/s].
        feedback: ZMP shift per DCM shift; above 1 brings the shift back.
        ankle: Tilt of the standing foot per tilt of the torso.
        ankle_rate: Likewise per rate of tilt, in [s].
        ankle_bandwidth: Of the filter of that tilt, in [1/s].
        edge: Distance that the ZMP keeps from the edge of the sole, in [m].
        reach_forward: Farthest footstep ahead of the support foot, in [m].
        reach_backward: Farthest footstep behind it, in [m].
        reach_outward: How much farther than the foot spacing a footstep may
            be to the side, in [m].
        gap: Least distance between soles that stand abreast, in [m].
        step_speed: Greatest speed at which an adapted footstep moves, [m/s].
        freeze: Part of the swing after which the footstep stays.
        stride_gain: Share of a footstep's shortfall that is learned.
        joint_gain: Of the integral of what the joints miss, in [1/s].
        joint_bound: Greatest correction of a joint, in [rad].
        joint_leak: Rate at which it is forgotten, in [1/s].
    """

    dead_zone: float = 0.015
    yielding: float = 5.0
    feedback: float = 4.0
    ankle: float = 0.3
    ankle_rate: float = 0.03
    ankle_bandwidth: float = 50.0
    edge: float = 0.002
    reach_forward: float = 0.08
    reach_backward: float = 0.08
    reach_outward: float = 0.02
    gap: float = 0.012
    step_speed: float = 1.5
    freeze: float = 0.95
    stride_gain: float = 0.3
    joint_gain: float = 10.0
    joint_bound: float = 0.03
    joint_leak: float = 1.0

    def __post_init__(self) -> None:
        """Refuse gains that mean nothing."""
        for name, unit in _NOT_NEGATIVE.items():
            check_not_negative(getattr(self, name), name, unit, ERROR)
        check_positive(self.feedback - 1.0, "feedback - 1", "1", ERROR)
        check_within(self.freeze, 0.0, 1.0, "freeze", "1", ERROR)


_NOT_NEGATIVE = {
    "dead_zone": "m",
    "yielding": "1/s",
    "ankle": "1",
    "ankle_rate": "s",
    "ankle_bandwidth": "1/s",
    "edge": "m",
    "reach_forward": "m",
    "reach_backward": "m",
    "reach_outward": "m",
    "gap": "m",
    "step_speed": "m/s",
    "stride_gain": "1",
    "joint_gain": "1/s",
    "joint_bound": "rad",
    "joint_leak": "1/s",
}


@dataclass(frozen=True, slots=True)
class MpcSettings:
    """Horizon and weights.

    Attributes:
        steps: Steps in the horizon.
        samples: Samples in a step.
        tail: What is assumed beyond the horizon.
        pull: Weight of the distance from the plan's ZMP against that of the
            added velocity, in [1/s^2].
    """

    steps: int = 2
    samples: int = 10
    tail: Tail = "anticipative"
    pull: float = 100.0

    def __post_init__(self) -> None:
        """Refuse an empty horizon and an unknown tail."""
        check_within(self.steps, 1, 10, "mpc.steps", "steps", ERROR)
        check_within(self.samples, 2, 100, "mpc.samples", "1", ERROR)
        check_positive(self.pull, "mpc.pull", "1/s^2", ERROR)
        if self.tail not in TAILS:
            raise ConfigurationError(
                f"mpc.tail must be one of {', '.join(TAILS)}, "
                f"got {self.tail!r}"
            )


@dataclass(frozen=True, slots=True)
class ControlSettings:
    """What control does besides planning.

    Attributes:
        method: Where the CoM comes from. "closed-form": each maneuver begins
            where the last one planned to be, the paper's way; "measured": it
            begins at the measured state; "mpc": it does, and in between the
            ZMP is that of the intrinsically stable MPC. The last two need
            feedback.
        feedback: Whether to estimate the state and stabilise the walk.
        stabiliser: Gains of the feedback.
        mpc: Horizon and weights of the MPC.
    """

    method: Method = "closed-form"
    feedback: bool = False
    stabiliser: StabiliserSettings = field(default_factory=StabiliserSettings)
    mpc: MpcSettings = field(default_factory=MpcSettings)

    def __post_init__(self) -> None:
        """Refuse an unknown method, and a measured state without sensors."""
        if self.method not in METHODS:
            raise ConfigurationError(
                f"method must be one of {', '.join(METHODS)}, "
                f"got {self.method!r}"
            )
        if self.method != "closed-form" and not self.feedback:
            raise ConfigurationError(
                f"method {self.method!r} needs feedback = true, got false"
            )


OPEN_LOOP = ControlSettings()
STABILISED = ControlSettings("measured", True)
