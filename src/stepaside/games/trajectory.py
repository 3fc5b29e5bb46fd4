"""Recorded motion of one player."""

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np

from ..core.brief_repr import brief_repr
from ..core.errors import ConfigurationError
from ..core.poses import Array
from ..planning import ManeuverPlan


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """Recorded motion of one player, one row per sample.

    Positions are in the world, in [m], angles in [rad]. Arrays that a player
    lacks are None. Headings are unwrapped.

    Attributes:
        com: CoM (x, y, z). Shape (n, 3).
        torso: Origin and heading of the torso (x, y, heading). Shape (n, 3).
        place: Reference point and heading (x, y, heading) in the world, in
            [m] and [rad]. Shape (n, 3).
        com_reference: Planned CoM (x, y). Shape (n, 2).
        zmp_reference: Planned ZMP (x, y). Shape (n, 2).
        zmp: Center of the foot forces (x, y); NaN in flight. Shape (n, 2).
        qpos: Position and quaternion of the torso, then the joint angles, in
            single precision. Shape (n, 7 + joints).
        landings: Time [s], side (1 left, -1 right), x, y, heading of each
            footstep. Shape (m, 5).
        sight: Time [s], estimated bearing and distance, true bearing and
            distance, 1 while the opponent is lost. Shape (k, 6).
        pushes: Time [s], duration [s], position of the torso (x, y) [m] and
            impulse (x, y) [N s] of each push. Shape (j, 6).
        velocity: Velocity of the CoM (x, y), in [m/s]. Shape (n, 2). This
            and the following arrays up to ``estimate`` are recorded in walks
            only.
        tilt: Roll and pitch of the torso. Shape (n, 2).
        sole: Pose (x, y, heading) of the support sole. Shape (n, 3).
        support: Support foot (1 left, -1 right), 1 in single support, and
            planned pose of the sole (x, y, heading). Shape (n, 5).
        heading_reference: Planned heading of the torso. Shape (n, 1).
        estimate: Estimated CoM, velocity of the CoM and ZMP (x, y each),
            roll and pitch; NaN before the first estimate. Shape (n, 8).
        command: Velocities of a robot with its own walk: of the template and
            as commanded, forward [m/s], turn [rad/s] and lateral [m/s]
            each. Shape (n, 6).
    """

    __repr__ = brief_repr

    com: Array
    torso: Array
    place: Array | None = None
    com_reference: Array | None = None
    zmp_reference: Array | None = None
    zmp: Array | None = None
    qpos: Array | None = None
    landings: Array | None = None
    sight: Array | None = None
    pushes: Array | None = None
    velocity: Array | None = None
    tilt: Array | None = None
    sole: Array | None = None
    support: Array | None = None
    heading_reference: Array | None = None
    estimate: Array | None = None
    command: Array | None = None

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for field in fields(self):
            value = getattr(self, field.name)
            if value is not None:
                value.setflags(write=False)

    @property
    def unicycle(self) -> Array:
        """Reference point and heading (x, y, heading). Shape (n, 3).

        Without a recorded reference point that of the torso is used.
        """
        return self.torso if self.place is None else self.place

    def arrays(self, name: str) -> dict[str, Array]:
        """Return all arrays by name, with the player's name as prefix."""
        found = {}
        for field in fields(self):
            value = getattr(self, field.name)
            if value is not None:
                found[f"{name}_{field.name}"] = value
        return found


FIELDS = tuple(field.name for field in fields(Trajectory))


@dataclass(frozen=True, slots=True, eq=False)
class PlanningTimes:
    """Planning times and plan quality of one player.

    Attributes:
        steps: Steps begun.
        times: Processor time of planning each maneuver, in [s]. Shape
            (replans,).
        velocity_jump: Greatest jump of the CoM velocity reference, in [m/s].
        zmp_margin: Smallest distance of the ZMP reference from the edge of
            the support polygon, in the executed parts of the plans, in [m];
            None without any.
    """

    steps: int
    times: Array
    velocity_jump: float
    zmp_margin: float | None


def margin_of(plans: list[ManeuverPlan]) -> float | None:
    """Return the smallest ZMP margin of the executed parts of plans [m]."""
    return min(
        (plan.margin(plan.schedule.first_step_duration) for plan in plans),
        default=None,
    )


WIDTHS: Mapping[str, int] = {
    **dict.fromkeys(("com", "torso", "place", "sole"), 3),
    **dict.fromkeys(("com_reference", "zmp_reference", "zmp"), 2),
    **dict.fromkeys(("velocity", "tilt"), 2),
    **dict.fromkeys(("landings", "support"), 5),
    **dict.fromkeys(("sight", "pushes", "command"), 6),
    **{"heading_reference": 1, "estimate": 8},
}
"""Columns of each array of a trajectory; qpos has at least seven."""
OF_EVENTS = ("landings", "sight", "pushes")  # not of samples
MAY_LACK = ("zmp", "sight", "estimate")  # values may be NaN
MAX_VALUE = 1e6  # of any number in a run, in [m], [rad] or [s]


def tracks_in(
    arrays: dict[str, Array], names: tuple[str, ...]
) -> dict[str, Trajectory]:
    """Return the trajectories of players from arrays by name.

    Raises:
        KeyError: If a required array is missing.
    """
    required = ("com", "torso")
    return {
        name: Trajectory(
            **{
                key: np.asarray(arrays[f"{name}_{key}"])
                for key in FIELDS
                if key in required or f"{name}_{key}" in arrays
            }
        )
        for name in names
    }


def check_record(
    times: Array, tracks: Mapping[str, Trajectory], run: str
) -> None:
    """Check times, and shapes and values of trajectories.

    Raises:
        ConfigurationError: If times do not increase, an array has another
            shape, or a value is not finite or too large.
    """
    if times.ndim != 1 or len(times) == 0:
        raise ConfigurationError(
            f"times_s of run {run} must be a row of at least one time [s], "
            f"got shape {times.shape}"
        )
    _check_values(times, "times_s", run)
    if times[0] < 0.0 or not np.all(np.diff(times) > 0.0):
        raise ConfigurationError(
            f"times_s of run {run} must be >= 0 and increase [s]"
        )
    for player, track in tracks.items():
        for key in FIELDS:
            array = getattr(track, key)
            if array is None:
                continue
            shape = array.shape if array.ndim == 2 else (-1, 0)
            rows = shape[0] if key in OF_EVENTS else len(times)
            width = WIDTHS.get(key, max(7, shape[1]))
            if shape != (rows, width):
                raise ConfigurationError(
                    f"{player}_{key} of run {run} must have shape "
                    f"({rows}, {width}), got {array.shape}"
                )
            _check_values(array, f"{player}_{key}", run, key in MAY_LACK)


def _check_values(
    array: Array, name: str, run: str, may_lack: bool = False
) -> None:
    valid = np.abs(array) <= MAX_VALUE
    if may_lack:
        valid |= np.isnan(array)
    if not valid.all():
        raise ConfigurationError(
            f"{name} of run {run} must hold finite numbers of at most "
            f"{MAX_VALUE:g}"
        )
