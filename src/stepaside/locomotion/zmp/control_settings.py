"""How a robot controls its walk."""

from dataclasses import dataclass, field
from typing import ClassVar, Literal, get_args

from ...core.errors import ConfigurationError
from ...core.ranges import Range, Ranges, check_settings

Method = Literal["closed-form", "measured", "mpc"]
METHODS: tuple[str, ...] = get_args(Method)
Tail = Literal["anticipative", "periodic", "truncated"]
TAILS: tuple[str, ...] = get_args(Tail)
SIZE = "some hundred feet long"
TICKS = "faster than a tick is at once"


@dataclass(frozen=True, slots=True)
class StabiliserSettings:
    """Gains and limits of the feedback.

    They were found by trying pushes of both bodies; see ``docs/walking.md``.

    Attributes:
        dead_zone: Error of the DCM that is left to the stiff joints, in [m]; 0
            to 10.
        yielding: Rate at which the reference gives way to an error beyond it,
            in [1/s]; 0 to 1000.
        feedback: ZMP shift per DCM shift; above 1 brings the shift back; above
            1 to 100.
        ankle: Tilt of the standing foot per tilt of the torso; 0 to 10.
        ankle_rate: Likewise per rate of tilt, in [s]; 0 to 10.
        ankle_bandwidth: Of the filter of that tilt, in [1/s]; 0 to 10000.
        edge: Distance that the ZMP keeps from the edge of the sole, in [m]; 0
            to 10.
        reach_forward: Farthest footstep ahead of the support foot, in [m]; 0
            to 10.
        reach_backward: Farthest footstep behind it, in [m]; 0 to 10.
        reach_outward: How much farther than the foot spacing a footstep may be
            to the side, in [m]; 0 to 10.
        gap: Least distance between soles that stand abreast, in [m]; 0 to 10.
        step_speed: Greatest speed at which an adapted footstep moves, [m/s]; 0
            to 100.
        freeze: Part of the swing after which the footstep stays; 0 to 1.
        stride_gain: Share of a footstep's shortfall that is learned; 0 to 1.
        stride_bound: Most of it that is learned, in [m]; 0 to 10.
        joint_gain: Of the integral of what the joints miss, in [1/s]; 0 to
            1000.
        joint_bound: Greatest correction of a joint, in [rad]; 0 to 3.2.
        joint_leak: Rate at which it is forgotten, in [1/s]; 0 to 1000.
        load_share: Share of what the servos give way under the load of the
            plan that is asked of them beforehand, as it is without feedback;
            0 to 1.
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
    stride_bound: float = 0.015
    joint_gain: float = 10.0
    joint_bound: float = 0.03
    joint_leak: float = 1.0
    load_share: float = 0.0

    ranges: ClassVar[Ranges] = {
        "dead_zone": Range(0.0, 10.0, "m", SIZE),
        "yielding": Range(0.0, 1000.0, "1/s", TICKS),
        "feedback": Range(
            *(1.0, 100.0, "1"),
            "at 1 a shift only stays; a hundredfold is noise",
            above=True,
        ),
        "ankle": Range(0.0, 10.0, "1", "more tilts the foot over"),
        "ankle_rate": Range(0.0, 10.0, "s", "more tilts the foot over"),
        "ankle_bandwidth": Range(0.0, 10000.0, "1/s", TICKS),
        "edge": Range(0.0, 10.0, "m", SIZE),
        "reach_forward": Range(0.0, 10.0, "m", SIZE),
        "reach_backward": Range(0.0, 10.0, "m", SIZE),
        "reach_outward": Range(0.0, 10.0, "m", SIZE),
        "gap": Range(0.0, 10.0, "m", SIZE),
        "step_speed": Range(0.0, 100.0, "m/s", "no foot is faster"),
        "freeze": Range(0.0, 1.0, "1", "a part"),
        "stride_gain": Range(0.0, 1.0, "1", "a share"),
        "stride_bound": Range(0.0, 10.0, "m", SIZE),
        "joint_gain": Range(0.0, 1000.0, "1/s", TICKS),
        "joint_bound": Range(0.0, 3.2, "rad", "joints turn no farther"),
        "joint_leak": Range(0.0, 1000.0, "1/s", TICKS),
        "load_share": Range(0.0, 1.0, "1", "a share"),
    }

    def __post_init__(self) -> None:
        """Refuse gains that mean nothing."""
        check_settings(self)


@dataclass(frozen=True, slots=True)
class MpcSettings:
    """Horizon and weights.

    Attributes:
        steps: Steps in the horizon; 1 to 10.
        samples: Samples in a step; 2 to 100.
        tail: What is assumed beyond the horizon.
        pull: Weight of the distance from the plan's ZMP against that of the
            added velocity, in [1/s^2]; 1e-06 to 1e+06.
    """

    steps: int = 2
    samples: int = 10
    tail: Tail = "anticipative"
    pull: float = 100.0

    ranges: ClassVar[Ranges] = {
        "steps": Range(
            1,
            10,
            "steps",
            "what the plan holds; more changes no millimetre",
            whole=True,
        ),
        "samples": Range(
            2, 100, "1", "finer than a tick is for nothing", whole=True
        ),
        "pull": Range(
            1e-6, 1e6, "1/s^2", "beyond, one of the two weights is nothing"
        ),
    }

    def __post_init__(self) -> None:
        """Refuse an empty horizon and an unknown tail."""
        check_settings(self, prefix="mpc.")
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
            ZMP is that of the intrinsically stable MPC, and in a room its
            footsteps keep to the free side of half planes. The last two need
            feedback.
        feedback: Whether to estimate the state and stabilise the walk.
        stabiliser: Gains of the feedback.
        mpc: Horizon and weights of the MPC.
        learn_turns: Whether to learn by the gyro how much of a turn is made,
            and to ask for as much more: feet twist on the floor.
    """

    method: Method = "closed-form"
    feedback: bool = False
    stabiliser: StabiliserSettings = field(default_factory=StabiliserSettings)
    mpc: MpcSettings = field(default_factory=MpcSettings)
    learn_turns: bool = False

    def __post_init__(self) -> None:
        """Refuse an unknown method, and a measured state without sensors."""
        check_settings(self)
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
