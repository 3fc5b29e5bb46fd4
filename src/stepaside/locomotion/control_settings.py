"""Settings of walking control, of learned legs, and of the map."""

from dataclasses import dataclass
from typing import Literal, get_args

from ..core.ranges import Range
from ..core.setting import CheckedSettings, setting

Method = Literal["closed-form", "measured", "mpc"]
METHODS: tuple[str, ...] = get_args(Method)
MAPS = ("given", "seen", "none")
UNKNOWN = ("free", "occupied")
SIZE = "about a hundred foot lengths"
TICKS = "a faster rate acts within one tick"


@dataclass(frozen=True, slots=True)
class StabiliserSettings(CheckedSettings):
    """Gains and limits of the stabiliser.

    They were tuned with pushes on both bodies; see ``docs/walking.md``.
    """

    dead_zone: float = setting(
        0.015,
        "DCM error that is left to the stiff joints",
        Range(0.0, 10.0, "m", SIZE),
    )
    yielding: float = setting(
        5.0,
        "Rate at which the reference follows an error beyond the dead zone",
        Range(0.0, 1000.0, "1/s", TICKS),
    )
    feedback: float = setting(
        4.0,
        "ZMP shift per DCM shift; above 1 brings the shift back",
        Range(
            1.0,
            100.0,
            "1",
            "at 1 a shift persists; 100 amplifies noise",
            above=True,
        ),
    )
    ankle: float = setting(
        0.3,
        "Tilt of the stance foot per tilt of the torso",
        Range(0.0, 10.0, "1", "a larger gain tips the foot"),
    )
    ankle_rate: float = setting(
        0.03,
        "Tilt of the stance foot per tilt rate of the torso",
        Range(0.0, 10.0, "s", "a larger gain tips the foot"),
    )
    edge: float = setting(
        0.002,
        "Smallest distance of the ZMP from the edge of the sole",
        Range(0.0, 10.0, "m", SIZE),
    )
    reach_forward: float = setting(
        0.08,
        "Farthest footstep ahead of the support foot",
        Range(0.0, 10.0, "m", SIZE),
    )
    reach_backward: float = setting(
        0.08,
        "Farthest footstep behind the support foot",
        Range(0.0, 10.0, "m", SIZE),
    )
    reach_outward: float = setting(
        0.02,
        "Largest step outward beyond the foot spacing",
        Range(0.0, 10.0, "m", SIZE),
    )
    gap: float = setting(
        0.012,
        "Smallest distance between soles abreast",
        Range(0.0, 10.0, "m", SIZE),
    )
    step_speed: float = setting(
        1.5,
        "Greatest speed at which an adapted footstep moves",
        Range(0.0, 100.0, "m/s", "no swing foot is faster"),
    )
    stride_gain: float = setting(
        0.3,
        "Learning gain of the shortfall of footsteps",
        Range(0.0, 1.0, "1", "a fraction"),
    )
    joint_gain: float = setting(
        10.0,
        "Gain of the integral of joint errors",
        Range(0.0, 1000.0, "1/s", TICKS),
    )
    joint_leak: float = setting(
        1.0,
        "Decay rate of the correction of a joint",
        Range(0.0, 1000.0, "1/s", TICKS),
    )
    load_share: float = setting(
        0.0,
        "Fraction of the servo deflection under load that is added to the "
        "joint targets as feedforward {unit}; without feedback all of it is",
        Range(0.0, 1.0, "1", "a fraction"),
    )


@dataclass(frozen=True, slots=True)
class MpcSettings(CheckedSettings, prefix="mpc."):
    """Horizon and weights of the MPC."""

    steps: int = setting(
        2,
        "MPC horizon, in footsteps",
        Range(
            1,
            10,
            "steps",
            "the steps of a plan; more change less than a millimetre",
            whole=True,
        ),
    )
    samples: int = setting(
        10,
        "MPC samples per footstep",
        Range(
            2,
            100,
            "1",
            "samples shorter than a tick have no effect",
            whole=True,
        ),
    )
    pull: float = setting(
        100.0,
        "Weight of the distance from the plan's ZMP over that of the added "
        "ZMP velocity",
        Range(
            1e-6, 1e6, "1/s^2", "beyond, one of the two weights is negligible"
        ),
    )


@dataclass(frozen=True, slots=True)
class ControlSettings(CheckedSettings):
    """Method and feedback of walking control.

    Method and feedback that are None are decided by gait and body; see
    :mod:`stepaside.games.player_settings`.
    """

    method: Method | None = setting(
        None,
        "Start of each maneuver: the state planned by the last one "
        "(closed-form, as in the paper), the measured state (measured), or "
        "the measured state with the intrinsically stable MPC in between "
        "(mpc); the last two need feedback",
        names=METHODS,
        default_text="closed-form; measured with feedback, unless steps are "
        "shorter than 0.4 s",
    )
    feedback: bool | None = setting(
        None,
        "Estimate the state and stabilise the gait, or execute plans in open "
        "loop",
        default_text="feedback unless the body is ideal; always with steps "
        "shorter than 0.4 s or another method than closed-form",
    )
    stabiliser: StabiliserSettings = setting(
        StabiliserSettings(), "Gains of the feedback"
    )
    mpc: MpcSettings = setting(
        MpcSettings(),
        "Horizon and weights of the MPC",
        needs=("control.method", "mpc"),
    )


OPEN_LOOP = ControlSettings("closed-form", False)
STABILISED = ControlSettings("measured", True)


@dataclass(frozen=True, slots=True)
class LegsSettings(CheckedSettings):
    """Walking policy of a robot, in place of the paper's walk."""

    network: str = setting(
        "",
        "ONNX file of a walking policy; empty for the paper's walk",
    )
    contract: str = setting(
        "",
        "Convention of the policy's trainer, as in docs/legs.md; empty to "
        "recognise it",
    )
    learn: bool = setting(
        True,
        "Correct the velocity of a walking policy by gyro and leg odometry",
    )


@dataclass(frozen=True, slots=True)
class MapSettings(CheckedSettings, prefix="map."):
    """Map of the room that robots use."""

    source: str = setting(
        "given",
        "Map of the room that each robot has: the true map with its true "
        "pose (given), a map built from its depth camera and odometry (seen, "
        "which implies camera sensing), or none",
        names=MAPS,
    )
    margin: float = setting(
        0.02,
        "Clearance that a body keeps from known obstacles",
        Range(0.0, 1.0, "m", "a larger margin leaves no free floor"),
    )
    unknown: str = setting(
        "occupied",
        "State of map cells that have not been observed",
        names=UNKNOWN,
        needs=("map.source", "seen"),
    )
