"""What a player knows when it decides, and what it decides."""

from dataclasses import dataclass
from typing import Any

from ..errors import check_finite, check_within
from ..poses import Pose


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
        pose: The frame in the own odometry.
        moving: Whether the body is under way.
        obstacles: What stands around, if it is known; nothing yet.
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
    obstacles: tuple[Any, ...] = ()


@dataclass(frozen=True, slots=True)
class Intent:
    """What a player wants.

    Attributes:
        heading: Desired heading in the frame of the knowledge, in [rad]: it
            sets the turning rate, from the next step on.
        speed_factor: Share of the gait's speed, in [0, 1]; 0 stops.
        moving: Whether to move at all.
    """

    heading: float = 0.0
    speed_factor: float = 1.0
    moving: bool = True

    def __post_init__(self) -> None:
        """Refuse what no body can do.

        Raises:
            PlanError: If a value is not finite, or the factor is not one.
        """
        check_finite(self.heading, "heading", "rad")
        check_within(self.speed_factor, 0.0, 1.0, "speed_factor", "1")

    @property
    def walks(self) -> bool:
        """Whether it asks for any motion."""
        return self.moving and self.speed_factor > 0.0


STAND = Intent(moving=False)
"""Stay, or come to rest."""
