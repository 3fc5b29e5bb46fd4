r"""Scaling of gait, feedback gains and game distances by robot size.

Robots of one shape walk alike if lengths scale with the CoM height z and
times with :math:`\sqrt{z / g}`, the time constant of the pendulum. The ratios
are those of NAO's gait, except that steps are quicker: heavier robots walked
best with shorter steps in trials.
"""

from dataclasses import dataclass
from math import pi, sqrt

from ..core.constants import GRAVITY

# Lengths by the CoM height.
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
TURNING = 0.033  # steering gain times the time constant
YIELDING = 0.83
JOINT_GAIN = 1.65
JOINT_LEAK = 0.165
ANKLE_RATE = 0.18
# Speeds by the speed sqrt(g z) of the pendulum.
STEP_SPEED = 0.92
PUSH = 0.12
INVERSE_NAO_MASS = 0.1885  # in [1/kg]
INVERSE_NAO_HEIGHT = 3.73  # of the CoM, in [1/m]
# Distances by that on the circle, 4 v sqrt(2) / (pi k).
SAFETY_RADIUS = 0.89
START_LEAST = 0.45
START_NEAR = 0.67
START_FAR = 1.67


@dataclass(frozen=True, slots=True)
class RobotSize:
    """Size of a robot, by which its gait is scaled.

    Attributes:
        com_height: Walking height of the CoM, in [m].
        mass: Mass of the robot, in [kg].
        foot_spacing: Distance between the feet, in [m].
        sole: Edges back, front, outer and inner, in [m]; only the back edge
            is negative.
        reach: Radius of the standing robot, in [m]; see
            :class:`stepaside.robots.description_types.ReferencePoint`.
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


def gait_of(size: RobotSize, lengths: float = 1.0) -> dict[str, float]:
    """Return the gait entries of a description, in SI units.

    Args:
        size: Size of the robot.
        lengths: Fraction of the nominal stride and step height.
    """
    z, time = size.com_height, size.time
    stride = _round(lengths * STRIDE * z)
    back, front, *_ = size.sole
    return {
        "speed": _round(stride / (PATH * time)),
        "gain": _round(TURNING / time),
        "stride": stride,
        "foot_spacing": _round(size.foot_spacing, 4),
        "step_height": _round(lengths * STEP_HEIGHT * z),
        "single_support": _round(SINGLE * time),
        "double_support": _round(DOUBLE * time),
        "start_support": _round(START * time),
        "com_height": round(z, 4),
        "zmp_forward": round(0.45 * (front + back), 4),
    }


def stabiliser_of(size: RobotSize) -> dict[str, float]:
    """Return the stabiliser entries of a description, in SI units."""
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
        "gap": _round(min(GAP * z, 0.5 * sole_gap(size))),
        "step_speed": _round(STEP_SPEED * size.speed),
        "stride_gain": 0.0,
        "stride_bound": _round(DEAD_ZONE * z),
        "joint_gain": _round(JOINT_GAIN / time),
        "joint_leak": _round(JOINT_LEAK / time),
        "load_share": 1.0,
    }


def game_of_size(size: RobotSize, gait: dict[str, float]) -> dict[str, float]:
    """Return the game entries, by the circle of two equal robots."""
    circle = 4.0 * sqrt(0.5) * gait["speed"] / (pi / 2 * gait["gain"])
    least = max(START_LEAST * circle, 2.0 * size.reach)
    return {
        "safety_radius": _round(max(SAFETY_RADIUS * circle, 1.2 * least)),
        "start_least": _round(least),
        "start_near": _round(max(START_NEAR * circle, 1.1 * least)),
        "start_far": _round(max(START_FAR * circle, 1.7 * least)),
        "push_unit": _round(PUSH * size.mass * size.speed),
        "force_unit": _round(INVERSE_NAO_MASS * size.mass),
        "length_unit": _round(INVERSE_NAO_HEIGHT * size.com_height),
    }


def sole_gap(size: RobotSize) -> float:
    """Return the gap between soles that stand abreast, in [m]."""
    return size.foot_spacing - 2.0 * size.sole[3]


def _round(value: float, digits: int = 3) -> float:
    """Round to significant digits."""
    return float(f"{value:.{digits}g}")
