r"""Scaling of gait, feedback gains and game distances by robot size.

Robots of one shape walk alike if lengths scale with the CoM height z and
times with :math:`\sqrt{z / g}`, the time constant of the pendulum. The ratios
are those of NAO's gait, except that steps are quicker: heavier robots walked
best with shorter steps in trials.
"""

from dataclasses import dataclass
from math import pi, sqrt

from ..core.constants import GRAVITY

# Lengths by the CoM height, times and rates by the time constant of the
# pendulum, speeds by its speed sqrt(g z).
STRIDE = 0.15
STEP_HEIGHT = 0.075
PATH = 2.42  # path time of a stride
TURNING = 0.033  # steering gain times the time constant
SUPPORTS = {
    "single_support": 2.0,
    "double_support": 0.58,
    "start_support": 4.8,
}
STABILISER_LENGTHS = {
    "dead_zone": 0.056,
    "edge": 0.0075,
    "reach_forward": 2.0 * STRIDE,
    "reach_backward": 2.0 * STRIDE,
    "reach_outward": 0.075,
}
STABILISER_RATES = {"yielding": 0.83, "joint_gain": 1.65, "joint_leak": 0.165}
GAP = 0.045
ANKLE_RATE = 0.18
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
    """Size of a robot, by which its gait is scaled."""

    com_height: float  # walking height of the CoM [m]
    mass: float  # mass of the robot [kg]
    foot_spacing: float  # distance between the feet [m]
    # edges back, front, outer and inner [m]; only the back edge is negative
    sole: tuple[float, float, float, float]
    reach: float  # radius of the standing robot [m]

    @property
    def time(self) -> float:
        """Time constant of the pendulum, in [s]."""
        return sqrt(self.com_height / GRAVITY)

    @property
    def speed(self) -> float:
        """Speed of the pendulum, in [m/s]."""
        return sqrt(self.com_height * GRAVITY)


def gait_of(size: RobotSize, lengths: float = 1.0) -> dict[str, float]:
    """Return the gait entries of a description, in SI units."""
    z, time = size.com_height, size.time
    stride = _round(lengths * STRIDE * z)
    back, front, *_ = size.sole
    return {
        "speed": _round(stride / (PATH * time)),
        "gain": _round(TURNING / time),
        "stride": stride,
        "foot_spacing": _round(size.foot_spacing, 4),
        "step_height": _round(lengths * STEP_HEIGHT * z),
        **{name: _round(part * time) for name, part in SUPPORTS.items()},
        "com_height": round(z, 4),
        "zmp_forward": round(0.45 * (front + back), 4),
    }


def stabiliser_of(size: RobotSize) -> dict[str, float]:
    """Return the stabiliser entries of a description, in SI units."""
    z, time = size.com_height, size.time
    lengths = {k: _round(v * z) for k, v in STABILISER_LENGTHS.items()}
    rates = {k: _round(v / time) for k, v in STABILISER_RATES.items()}
    gap = size.foot_spacing - 2.0 * size.sole[3]  # of soles abreast
    return {
        **lengths,
        **rates,
        "ankle_rate": _round(ANKLE_RATE * time),
        "gap": _round(min(GAP * z, 0.5 * gap)),
        "step_speed": _round(STEP_SPEED * size.speed),
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


def _round(value: float, digits: int = 3) -> float:
    """Round to significant digits."""
    return float(f"{value:.{digits}g}")
