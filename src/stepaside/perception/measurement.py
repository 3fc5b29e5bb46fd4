"""What a robot's own sensors give."""

from typing import TYPE_CHECKING, NamedTuple

from ..core.poses import Array, Pose

if TYPE_CHECKING:
    from .images import Percept


class Sighting(NamedTuple):
    """The other robot, as a sensor of this one saw it.

    Attributes:
        time: When it was seen, in [s].
        bearing: Direction of the other in the horizontal plane, from the
            heading of this robot's torso, in [rad], positive leftward.
        distance: Horizontal distance to the other, in [m].
        who: Number of who it is, where several may come.
        settled: Whether it was watched long enough to tell where it goes.
        spread: Standard deviation of its place, in [m].
    """

    time: float
    bearing: float
    distance: float
    who: int = 0
    settled: bool = True
    spread: float = 0.0


class Measurement(NamedTuple):
    """What a robot's own sensors give at one control tick.

    Attributes:
        time: Time of the tick, in [s].
        joint_positions: Encoders, in [rad], in the order of the joint
            targets. Shape (joints,).
        gyro: Angular velocity of the torso in its frame, in [rad/s]; its
            third axis is NaN where the robot measures two. Shape (3,).
        accelerometer: Specific force at the torso in its frame, in [m/s^2].
            Shape (3,).
        foot_forces: Pressing force at the corners of the soles, in [N]:
            left front-left, front-right, rear-left, rear-right, then right.
            Shape (8,).
        sighting: Newest sighting of the other robot, if there is any.
        percepts: Images and echoes that have arrived since the last tick.
        place: CoM and heading of the torso on the floor of a room that is
            known, from a sensor that tells them.
    """

    time: float
    joint_positions: Array
    gyro: Array
    accelerometer: Array
    foot_forces: Array
    sighting: Sighting | None
    percepts: tuple["Percept", ...] = ()
    place: Pose | None = None
