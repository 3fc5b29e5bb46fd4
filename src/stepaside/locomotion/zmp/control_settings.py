"""Settings of walking control."""

from dataclasses import dataclass, field
from typing import ClassVar, Literal, get_args

from ...core.errors import ConfigurationError
from ...core.ranges import Range, Ranges, check_settings

Method = Literal["closed-form", "measured", "mpc"]
METHODS: tuple[str, ...] = get_args(Method)
Tail = Literal["anticipative", "periodic", "truncated"]
TAILS: tuple[str, ...] = get_args(Tail)
SIZE = "about a hundred foot lengths"
TICKS = "a faster rate acts within one tick"


@dataclass(frozen=True, slots=True)
class StabiliserSettings:
    """Gains and limits of the stabiliser.

    They were tuned with pushes on both bodies; see ``docs/walking.md``.

    Attributes:
        dead_zone: DCM error that is left to the stiff joints, in [m]; 0 to 10.
        yielding: Rate at which the reference follows an error beyond the dead
            zone, in [1/s]; 0 to 1000.
        feedback: ZMP shift per DCM shift; above 1 brings the shift back; above
            1 to 100.
        ankle: Tilt of the stance foot per tilt of the torso; 0 to 10.
        ankle_rate: Likewise per tilt rate, in [s]; 0 to 10.
        ankle_bandwidth: Bandwidth of the filter of that tilt, in [1/s]; 0 to
            10000.
        edge: Distance of the ZMP from the edge of the sole, in [m]; 0 to 10.
        reach_forward: Farthest footstep ahead of the support foot, in [m]; 0
            to 10.
        reach_backward: Farthest footstep behind it, in [m]; 0 to 10.
        reach_outward: Largest step outward beyond the foot spacing, in [m];
            0 to 10.
        gap: Least distance between soles abreast, in [m]; 0 to 10.
        step_speed: Greatest speed at which an adapted footstep moves, [m/s]; 0
            to 100.
        freeze: Fraction of the swing after which the footstep is fixed; 0 to
            1.
        stride_gain: Learning gain of a footstep's shortfall; 0 to 1.
        stride_bound: Largest learned shortfall, in [m]; 0 to 10.
        joint_gain: Gain of the integral of joint errors, in [1/s]; 0 to 1000.
        joint_bound: Largest correction of a joint, in [rad]; 0 to 3.2.
        joint_leak: Decay rate of the correction, in [1/s]; 0 to 1000.
        load_share: Fraction of the servo deflection under load that is added
            to the targets as feedforward; without feedback all of it is; 0
            to 1.
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
            1.0,
            100.0,
            "1",
            "at 1 a shift persists; 100 amplifies noise",
            above=True,
        ),
        "ankle": Range(0.0, 10.0, "1", "a larger gain tips the foot"),
        "ankle_rate": Range(0.0, 10.0, "s", "a larger gain tips the foot"),
        "ankle_bandwidth": Range(0.0, 10000.0, "1/s", TICKS),
        "edge": Range(0.0, 10.0, "m", SIZE),
        "reach_forward": Range(0.0, 10.0, "m", SIZE),
        "reach_backward": Range(0.0, 10.0, "m", SIZE),
        "reach_outward": Range(0.0, 10.0, "m", SIZE),
        "gap": Range(0.0, 10.0, "m", SIZE),
        "step_speed": Range(0.0, 100.0, "m/s", "no swing foot is faster"),
        "freeze": Range(0.0, 1.0, "1", "a fraction"),
        "stride_gain": Range(0.0, 1.0, "1", "a fraction"),
        "stride_bound": Range(0.0, 10.0, "m", SIZE),
        "joint_gain": Range(0.0, 1000.0, "1/s", TICKS),
        "joint_bound": Range(0.0, 3.2, "rad", "half a turn of a joint"),
        "joint_leak": Range(0.0, 1000.0, "1/s", TICKS),
        "load_share": Range(0.0, 1.0, "1", "a fraction"),
    }

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_settings(self)


@dataclass(frozen=True, slots=True)
class MpcSettings:
    """Horizon and weights of the MPC.

    Attributes:
        steps: Number of steps in the horizon; 1 to 10.
        samples: Number of samples per step; 2 to 100.
        tail: ZMP assumed beyond the horizon.
        pull: Weight of the distance from the plan's ZMP over that of the added
            velocity, in [1/s^2]; 1e-06 to 1e+06.
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
            "the steps of a plan; more change less than a millimetre",
            whole=True,
        ),
        "samples": Range(
            2,
            100,
            "1",
            "samples shorter than a tick have no effect",
            whole=True,
        ),
        "pull": Range(
            1e-6, 1e6, "1/s^2", "beyond, one of the two weights is negligible"
        ),
    }

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_settings(self, prefix="mpc.")
        if self.tail not in TAILS:
            raise ConfigurationError(
                f"mpc.tail must be one of {', '.join(TAILS)}, "
                f"got {self.tail!r}"
            )


@dataclass(frozen=True, slots=True)
class ControlSettings:
    """Method and feedback of walking control.

    Attributes:
        method: Source of the CoM motion. "closed-form": each maneuver begins
            at the state that the last one planned, as in the paper;
            "measured": it begins at the measured state; "mpc": likewise, with
            the ZMP of the intrinsically stable MPC in between, and in a room
            with footsteps on the free side of half planes. The last two need
            feedback.
        feedback: Whether to estimate the state and stabilise the walk.
        stabiliser: Gains of the feedback.
        mpc: Horizon and weights of the MPC.
        learn_turns: Whether to calibrate turns by the gyro, since feet twist
            on the floor.
    """

    method: Method = "closed-form"
    feedback: bool = False
    stabiliser: StabiliserSettings = field(default_factory=StabiliserSettings)
    mpc: MpcSettings = field(default_factory=MpcSettings)
    learn_turns: bool = False

    def __post_init__(self) -> None:
        """Validate the settings."""
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
