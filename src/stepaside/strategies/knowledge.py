"""What a player knows when it decides, and what it decides."""

from dataclasses import dataclass

import numpy as np

from ..arena import Obstacle
from ..core.errors import (
    PlanError,
    check_bearing,
    check_positive,
    check_within,
    shown,
)
from ..core.poses import Pose


@dataclass(frozen=True, slots=True)
class Limits:
    """What the own gait can do.

    Attributes:
        speed: Driving speed of the template at speed factor 1, in [m/s] of
            path time.
        gain: Steering gain k, in [1/s] of path time; in (6) the turning
            rate, in [rad/s].
        stride: Way of one step at speed factor 1, in [m].
        step_duration: Time from one decision under way to the next, in [s].
    """

    speed: float
    gain: float
    stride: float
    step_duration: float


@dataclass(frozen=True, slots=True)
class Knowledge:
    """What a player knows of the other and of itself.

    The frame is that of the unicycle that stands for the body, where it was
    when the other was seen: of a walker midway between its feet, along the
    path that it walks. So the bearing compares a line of sight with a
    heading of the same instant.

    Attributes:
        time: Now, in [s].
        bearing: Direction of the other in the frame, in [-pi, pi], in
            [rad], positive to the left.
        distance: Horizontal distance to the other when it was seen, in [m].
        limits: What the own gait can do.
        bearing_rate: How fast the line of sight turns on the floor, in
            [rad/s]; None where it is not known yet.
        closing_speed: How fast the distance shrinks, in [m/s]; None where
            it is not known yet.
        age: Time since the other was seen, in [s].
        pose: The frame in the own odometry, or in the frame of a room that
            is known.
        moving: Whether the body is under way.
        obstacles: What is known to stand around, walls as well, in the
            frame in which the pose is.
        velocity: Of the other on the floor, ahead and to the left in the
            frame, in [m/s]; None where it is not known yet.
        begins: Where the step begins that is decided, in the frame in which
            the pose is; None where it begins there. A walker decides when
            a foot has landed, and its body passes that foot half a step
            later.
        spread: Standard deviation of the place of the other, in [m].
        blur: How far off what is known to stand around may be, in [m].
    """

    time: float
    bearing: float
    distance: float
    limits: Limits
    bearing_rate: float | None = None
    closing_speed: float | None = None
    age: float = 0.0
    pose: Pose = Pose(0.0, 0.0, 0.0)
    moving: bool = False
    obstacles: tuple[Obstacle, ...] = ()
    velocity: tuple[float, float] | None = None
    begins: Pose | None = None
    spread: float = 0.0
    blur: float = 0.0

    def __post_init__(self) -> None:
        """Refuse a bearing that is none.

        Raises:
            PlanError: If the bearing lies outside of one turn either way.
        """
        check_bearing(self.bearing, "bearing")


@dataclass(frozen=True, slots=True)
class Intent:
    """What a player wants.

    Attributes:
        heading: Desired heading in the frame of the knowledge, in [rad]: it
            sets the turning rate, from the next step on.
        speed_factor: Share of the gait's speed, in [0, 1]; 0 stops.
        moving: Whether to move at all.
        pace: Share of the gait's step rate, in (0, 1]: the same steps, and
            turns, in more time. Half of it is the least that is walked.
    """

    heading: float = 0.0
    speed_factor: float = 1.0
    moving: bool = True
    pace: float = 1.0

    def __post_init__(self) -> None:
        """Refuse what no body can do.

        Raises:
            PlanError: If the heading lies outside of one turn either way, the
                factor is not in [0, 1], or moving is neither true nor false.
        """
        check_bearing(self.heading, "heading")
        if type(self.moving) is not bool and not isinstance(
            self.moving, np.bool_
        ):
            raise PlanError(
                f"moving must be true or false, got {shown(self.moving)}"
            )
        check_within(self.speed_factor, 0.0, 1.0, "speed_factor", "1")
        check_positive(self.pace, "pace", "1")
        check_within(self.pace, 0.0, 1.0, "pace", "1")

    @property
    def walks(self) -> bool:
        """Whether it asks for any motion."""
        return self.moving and self.speed_factor > 0.0


ON_THE_SPOT = 0.05  # share of the speed at which a body but turns

STAND = Intent(moving=False)
"""Stay, or come to rest."""
