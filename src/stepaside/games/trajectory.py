"""What one player left behind: its way through the world."""

from dataclasses import dataclass, fields

import numpy as np

from ..core.brief_repr import brief_repr
from ..core.poses import Array
from ..planning import ManeuverPlan


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """Record of one player, one row per sample; what it lacks is None.

    Positions are in the world, in [m], angles in [rad].

    Attributes:
        com: CoM. Shape (n, 3).
        torso: Origin of the torso and its heading, which does not wrap.
            Shape (n, 3).
        place: Point that stands for the player in the game, likewise with
            the heading. Shape (n, 3).
        com_reference: What its plan asks of the CoM. Shape (n, 2).
        zmp_reference: What it asks of the ZMP. Shape (n, 2).
        zmp: Center of the foot forces; NaN in flight. Shape (n, 2).
        qpos: Place and quaternion of the torso, then the joints, in single
            precision. Shape (n, 7 + joints).
        landings: Time [s], side (1 left, -1 right), x, y, heading of each
            footstep. Shape (m, 5).
        sight: Time [s], believed bearing and distance, true ones, whether
            the other was lost. Shape (k, 6).
        pushes: Of those that were given: time and duration [s], place of the
            torso (x, y) [m], impulse (x, y) [N s]. Shape (j, 6).
        velocity: Of the CoM (x, y), in [m/s], where a walk is looked at
            closely, as is all that follows. Shape (n, 2).
        tilt: Roll and pitch of the torso. Shape (n, 2).
        sole: Place and heading of the sole that bears. Shape (n, 3).
        support: Which foot bears (1 left, -1 right), whether it does so
            alone, and where its plan has it (x, y, heading). Shape (n, 5).
        heading_reference: What is asked of the torso. Shape (n, 1).
        estimate: What feedback believes: CoM, its velocity and ZMP (x, y
            each), roll and pitch; NaN before it does. Shape (n, 8).
        command: Velocities of a robot that walks by itself: what the
            template wanted and what was asked for, forward [m/s] and turn
            [rad/s] each. Shape (n, 4).
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
        """Close what is written for good."""
        for field in fields(self):
            value = getattr(self, field.name)
            if value is not None:
                value.setflags(write=False)

    @property
    def unicycle(self) -> Array:
        """Place and heading by which the game is judged. Shape (n, 3).

        Records that are older than the place have the torso.
        """
        return self.torso if self.place is None else self.place

    def arrays(self, name: str) -> dict[str, Array]:
        """Everything that there is, by name of the player and the array."""
        found = {}
        for field in fields(self):
            value = getattr(self, field.name)
            if value is not None:
                found[f"{name}_{field.name}"] = value
        return found


FIELDS = tuple(field.name for field in fields(Trajectory))


@dataclass(frozen=True, slots=True, eq=False)
class PlanningTimes:
    """How one player planned.

    Attributes:
        steps: Steps begun.
        times: Processor time of each maneuver, in [s]. Shape (replans,).
        velocity_jump: Greatest jump of the CoM velocity reference, in [m/s].
        zmp_margin: Least distance of the ZMP reference from the edge of the
            support polygon, in what was walked, in [m]; None if nothing was.
    """

    steps: int
    times: Array
    velocity_jump: float
    zmp_margin: float | None


def margin_of(plans: list[ManeuverPlan]) -> float | None:
    """Least ZMP margin of plans in the parts that were walked, in [m]."""
    return min(
        (plan.margin(plan.schedule.first_step_duration) for plan in plans),
        default=None,
    )


def tracks_in(
    arrays: dict[str, Array], names: tuple[str, ...]
) -> dict[str, Trajectory]:
    """Tracks of players from arrays by name.

    Raises:
        KeyError: If one that everybody has is missing.
    """
    needed = ("com", "torso")
    return {
        name: Trajectory(
            **{
                key: np.asarray(arrays[f"{name}_{key}"])
                for key in FIELDS
                if key in needed or f"{name}_{key}" in arrays
            }
        )
        for name in names
    }
