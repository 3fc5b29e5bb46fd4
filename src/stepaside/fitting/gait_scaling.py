r"""Gait, control and distances of a robot, from its size alone.

Two robots of one shape walk alike when lengths go with the height z of the
CoM and times with :math:`\sqrt{z / g}`, the time constant of the pendulum.
The ratios below are those of NAO's gait, with one exception: heavier robots
in trials walked best with quicker steps, so that these are shorter.
"""

from dataclasses import dataclass
from math import pi, sqrt

from ..core.constants import GRAVITY

# Lengths by the height of the CoM.
STRIDE = 0.15
STEP_HEIGHT = 0.075
DEAD_ZONE = 0.056
EDGE = 0.0075
GAP = 0.045
OUTWARD = 0.075
# Times by the time constant of the pendulum.
SINGLE = 2.0
DOUBLE = 0.58
START = 4.8
PATH = 2.42  # path time of a stride
TURNING = 0.033  # its inverse: steering gain
YIELDING = 0.83
JOINT_GAIN = 1.65
JOINT_LEAK = 0.165
ANKLE_RATE = 0.18
# Speeds by that of the pendulum, sqrt(g z).
STEP_SPEED = 0.92
PUSH = 0.12
# Sizes by NAO's: by its mass, in [1/kg], and by the height of its CoM, [1/m].
WEIGHT, HEIGHT = 0.1885, 3.73
# Distances by the circle's, 4 v sqrt(2) / (pi k).
SAFETY = 0.89
NEAREST, NEAR, FAR = 0.45, 0.67, 1.67


@dataclass(frozen=True, slots=True)
class RobotSize:
    """What a gait is scaled by.

    Attributes:
        com_height: Height of the CoM at which it walks, in [m].
        mass: Mass of the robot, in [kg].
        foot_spacing: Distance between the feet, in [m].
        sole: Edges back, front, outer and inner, in [m], none negative but
            the first.
        reach: See
            :class:`stepaside.robots.description_types.ReferencePoint`, in [m].
    """

    com_height: float
    mass: float
    foot_spacing: float
    sole: tuple[float, float, float, float]
    reach: float

    @property
    def time(self) -> float:
        """Time constant of the pendulum, in [s]."""
        return sqrt(self.com_height / GRAVITY)

    @property
    def speed(self) -> float:
        """Speed of the pendulum, in [m/s]."""
        return sqrt(self.com_height * GRAVITY)


def gait_of(size: RobotSize, share: float = 1.0) -> dict[str, float]:
    """Entries of a gait, as a description has them, in SI units.

    Args:
        size: What it is scaled by.
        share: Share of stride and step height that is walked.
    """
    z, time = size.com_height, size.time
    stride = _round(share * STRIDE * z)
    back, front, *_ = size.sole
    return {
        "speed": _round(stride / (PATH * time)),
        "gain": _round(TURNING / time),
        "stride": stride,
        "foot_spacing": _round(size.foot_spacing, 4),
        "step_height": _round(share * STEP_HEIGHT * z),
        "single_support": _round(SINGLE * time),
        "double_support": _round(DOUBLE * time),
        "start_support": _round(START * time),
        "com_height": round(z, 4),
        "zmp_forward": round(0.45 * (front + back), 4),
    }


def stabiliser_of(size: RobotSize) -> dict[str, float]:
    """Entries of the feedback, likewise."""
    z, time = size.com_height, size.time
    stride = STRIDE * z
    return {
        "dead_zone": _round(DEAD_ZONE * z),
        "yielding": _round(YIELDING / time),
        "ankle_rate": _round(ANKLE_RATE * time),
        "edge": _round(EDGE * z),
        "reach_forward": _round(2.0 * stride),
        "reach_backward": _round(2.0 * stride),
        "reach_outward": _round(OUTWARD * z),
        "gap": _round(min(GAP * z, 0.5 * spare(size))),
        "step_speed": _round(STEP_SPEED * size.speed),
        "stride_gain": 0.0,
        "stride_bound": _round(DEAD_ZONE * z),
        "joint_gain": _round(JOINT_GAIN / time),
        "joint_leak": _round(JOINT_LEAK / time),
        "load_share": 1.0,
    }


def game_of_size(size: RobotSize, gait: dict[str, float]) -> dict[str, float]:
    """Entries of a game, by the circle that equal robots end on."""
    circle = 4.0 * sqrt(0.5) * gait["speed"] / (pi / 2 * gait["gain"])
    least = max(NEAREST * circle, 2.0 * size.reach)
    return {
        "safety_radius": _round(max(SAFETY * circle, 1.2 * least)),
        "start_least": _round(least),
        "start_near": _round(max(NEAR * circle, 1.1 * least)),
        "start_far": _round(max(FAR * circle, 1.7 * least)),
        "push_unit": _round(PUSH * size.mass * size.speed),
        "force_unit": _round(WEIGHT * size.mass),
        "length_unit": _round(HEIGHT * size.com_height),
    }


def spare(size: RobotSize) -> float:
    """Gap between soles that stand abreast, in [m]."""
    return size.foot_spacing - 2.0 * size.sole[3]


def _round(value: float, digits: int = 3) -> float:
    """A value with a few digits that count."""
    return float(f"{value:.{digits}g}")
