"""Recorded motion and signals of one player."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array, wrap_angles

if TYPE_CHECKING:
    from ..perception.images import ColourImage, DepthImage

POSE = ("x_m", "y_m", "heading_rad")
POINT = ("x_m", "y_m")
ON_FLOOR = (1.0, 1.0, 0.0)  # times a pose: its position, as that of a CoM
RATES = ("x_rad_s", "y_rad_s", "z_rad_s")
OF_EVENTS = ("landings", "sight", "pushes", "plans")  # not of samples
MAY_LACK = ("zmp", "sight", "estimate", "joint_targets")  # may be NaN


def table(*columns: str) -> Any:
    """Return a field of an array with columns; without any one per joint."""
    return field(default=None, metadata={"columns": columns})


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """Recorded motion of one player, one row per sample unless noted.

    Positions are in the world, in [m], angles in [rad]; headings are
    unwrapped. ``COLUMNS`` names the columns. Arrays that a player lacks are
    None; those from ``velocity`` on are recorded in walks, and when a game is
    repeated. Then they are true, without sensor errors; those of a play are
    measurements.
    """

    com: Array = table("x_m", "y_m", "z_m")
    torso: Array = table(*POSE)  # origin and heading
    place: Array | None = table(*POSE)  # reference point and heading
    com_reference: Array | None = table(*POINT)  # planned
    zmp_reference: Array | None = table(*POINT)  # planned
    zmp: Array | None = table(*POINT)  # center of the foot forces; or NaN
    qpos: Array | None = table()
    """Position and quaternion of the torso, and joint angles, as float32."""
    landings: Array | None = table("time_s", "side", *POSE)
    """Of each footstep; the side is 1 left, -1 right."""
    sight: Array | None = table(
        *("time_s", "bearing_rad", "distance_m"),
        *("true_bearing_rad", "true_distance_m", "is_lost"),
    )
    """Of each sighting."""
    pushes: Array | None = table(
        *("time_s", "duration_s", *POINT, "impulse_x_n_s", "impulse_y_n_s"),
    )
    """Of each push, at the torso."""
    command: Array | None = table(
        *("template_forward_m_s", "template_turn_rad_s"),
        *("template_lateral_m_s", "forward_m_s", "turn_rad_s"),
        "lateral_m_s",
    )
    """Velocities of a robot with its own walk: of the template and as
    commanded."""
    velocity: Array | None = table("x_m_s", "y_m_s")  # of the CoM
    tilt: Array | None = table("roll_rad", "pitch_rad")  # of the torso
    sole: Array | None = table(*POSE)  # support sole
    support: Array | None = table("side", "single", *POSE)
    """Support foot (1 left, -1 right), 1 in single support, planned pose of
    the sole."""
    heading_reference: Array | None = table("heading_rad")  # of the torso
    estimate: Array | None = table(
        *("com_x_m", "com_y_m", "velocity_x_m_s", "velocity_y_m_s"),
        *("zmp_x_m", "zmp_y_m", "roll_rad", "pitch_rad"),
    )
    """Of the state estimator; or NaN."""
    dcm: Array | None = table(*POINT)  # of a walk by maneuvers
    plans: Array | None = table("time_s", "number", "side", *POSE)
    """Of each footstep of a maneuver: time at which its first step begins,
    number in the maneuver, side and pose."""
    phase: Array | None = table("phase")  # index in ``Phase``
    torso_velocity: Array | None = table(
        *("x_m_s", "y_m_s", "z_m_s"), *(f"about_{name}" for name in RATES)
    )
    """Linear in the world, angular in the torso."""
    joint_velocity: Array | None = table()  # of joints in the order of qpos
    joint_effort: Array | None = table()  # of motors at the joints [N m]
    joint_targets: Array | None = table()  # in force; NaN without a motor
    gyro: Array | None = table(*RATES)  # in the torso
    accelerometer: Array | None = table("x_m_s2", "y_m_s2", "z_m_s2")
    """Specific force, in the torso."""
    foot_forces: Array | None = table(
        *(
            f"{side}_{end}_{edge}_n"
            for side in ("left", "right")
            for end in ("front", "rear")
            for edge in ("left", "right")
        )
    )
    strategy: Mapping[str, Array] = field(default_factory=dict)
    """Numbers of the strategy by name, NaN where there is none: sighting,
    desired heading, entries of its memory. Not in a run folder."""
    images: "tuple[ColourImage | DepthImage, ...]" = ()
    """Images of the cameras. Not in a run folder."""

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for values in self.arrays().values():
            values.setflags(write=False)

    @property
    def unicycle(self) -> Array:
        """Reference point and heading (x, y, heading). Shape (n, 3).

        Without a recorded reference point that of the torso is used.
        """
        return self.torso if self.place is None else self.place

    def arrays(self, prefix: str = "") -> dict[str, Array]:
        """Return all arrays by name, with a prefix."""
        return {
            prefix + name: values
            for name in COLUMNS
            if (values := getattr(self, name)) is not None
        }


COLUMNS: Mapping[str, tuple[str, ...]] = {
    own.name: own.metadata["columns"]
    for own in fields(Trajectory)
    if "columns" in own.metadata
}
"""Columns of each array, with units; none of those with a column per joint."""


def last_third(times: Array) -> NDArray[np.bool_]:
    """Return the mask of the samples in the last third. Shape (n,)."""
    tail: NDArray[np.bool_] = times >= times[-1] * 2.0 / 3.0
    return tail


def distance_between(first: Array, second: Array) -> Array:
    """Return the distances, in [m], between poses. Shapes (n, 3), (n,)."""
    distance: Array = np.hypot(*(second - first)[:, :2].T)
    return distance


def angle_between(first: Array, second: Array) -> Array:
    """Return the angles between headings of poses (n, 3), in [0, pi]."""
    angle: Array = np.abs(wrap_angles(second[:, 2] - first[:, 2]))
    return angle


def cycle_mean(values: Array, times: Array, period: float) -> Array:
    """Average over a sliding gait cycle, which removes the sway.

    The times are evenly spaced; the period is that of two steps, in [s].
    """
    if len(times) < 3:
        return values
    width = max(1, round(period / float(times[1] - times[0])))
    if width >= len(values):
        return np.full_like(values, values.mean())
    kernel = np.ones(width)
    weight = np.convolve(np.ones_like(values), kernel, mode="same")
    mean: Array = np.convolve(values, kernel, mode="same") / weight
    return mean


def whole_cycles(values: Array, times: Array, period: float) -> Array:
    """Return :func:`cycle_mean`, with NaN where the cycle is not whole."""
    mean = cycle_mean(values, times, period).astype(float)
    if len(times) < 3:
        return np.full(len(times), np.nan)
    half = round(period / float(times[1] - times[0])) // 2
    mean[:half] = mean[max(len(mean) - half, 0) :] = np.nan
    return mean
