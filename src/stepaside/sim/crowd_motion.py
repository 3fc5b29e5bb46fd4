"""Walk of a person to a goal among other players.

The reaction is the social force model of D. Helbing and P. Molnár (Physical
Review E 51, 1995): an acceleration towards the desired velocity, and a
repulsion from each other player and wall that decays with the distance.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, exp, hypot

from ..arena import NO_OBSTACLES, ObstacleSet
from ..core.poses import Pose
from ..core.ranges import Range
from ..core.setting import check_settings, setting

REACTIONS = ("none", "avoid", "avoid-people")
RELAXATION = 0.5  # time to reach the desired velocity, in [s]
STRENGTH = 3.0  # of the repulsion at contact, in [m/s^2]
RANGE = 0.3  # in which the repulsion decays by e, in [m]
RADIUS = 0.25  # of a person, in [m]
ARRIVED = 0.2  # distance from the goal at which the person halts, in [m]
BEHIND = 0.3  # share of the repulsion from players out of sight
FASTEST = 1.3  # greatest speed over the desired one


@dataclass(frozen=True, slots=True)
class CrowdSettings:
    """Walk of a person to a goal."""

    speed: float = setting(
        0.8,
        "Desired speed of the person",
        Range(0.0, 3.0, "m/s", "faster is running"),
    )
    reaction: str = setting(
        "avoid",
        "What the person gives way to: nothing, everybody, or people but not "
        "robots",
        names=REACTIONS,
    )
    returns: bool = setting(
        False, "Walk back to the start, and again, instead of halting"
    )

    def __post_init__(self) -> None:
        """Check the ranges."""
        check_settings(self, prefix="crowd.")


@dataclass(frozen=True, slots=True)
class Neighbour:
    """Another player, as a person sees it.

    Attributes:
        x: Position in the world, in [m].
        y: Likewise.
        is_person: Whether it is a person.
        radius: Radius of its body, in [m].
    """

    x: float
    y: float
    is_person: bool
    radius: float = RADIUS


class CrowdMotion:
    """Walk of a person to a goal, integrated step by step.

    Attributes:
        pose: Pose of the person in the world.
        arrived_at: Time of the first arrival at the goal, in [s]; None
            before.
    """

    def __init__(
        self,
        settings: CrowdSettings,
        start: Pose,
        goal: tuple[float, float],
        obstacles: ObstacleSet = NO_OBSTACLES,
    ) -> None:
        """Start a walk.

        Args:
            settings: Settings of the walk.
            start: Initial pose in the world.
            goal: Goal in the world, in [m].
            obstacles: Walls and obstacles of the room.
        """
        self._settings, self._obstacles = settings, obstacles
        self.pose = start
        self._goals = [goal, start[:2]]
        self._velocity = 0.0, 0.0
        self.arrived_at: float | None = None

    def advance(
        self, time: float, duration: float, others: Sequence[Neighbour]
    ) -> None:
        """Advance the walk by one step.

        Args:
            time: Time at the end of the step, in [s].
            duration: Duration of the step, in [s].
            others: All other players.
        """
        x, y, theta = self.pose
        settings, (vx, vy) = self._settings, self._velocity
        gx, gy = self._goals[0]
        left = hypot(gx - x, gy - y)
        if left < ARRIVED:
            if self.arrived_at is None:
                self.arrived_at = time
            if settings.returns:
                self._goals.reverse()
        wanted = settings.speed if left >= ARRIVED else 0.0
        scale = wanted / left if left > 0.0 else 0.0
        ax = (scale * (gx - x) - vx) / RELAXATION
        ay = (scale * (gy - y) - vy) / RELAXATION
        if settings.reaction != "none":
            fx, fy = self._repulsion(others)
            ax, ay = ax + fx, ay + fy
        vx, vy = vx + ax * duration, vy + ay * duration
        speed, most = hypot(vx, vy), FASTEST * settings.speed
        if speed > most:
            vx, vy = vx * most / speed, vy * most / speed
        self._velocity = vx, vy
        if hypot(vx, vy) > 0.05:
            theta = atan2(vy, vx)
        self.pose = Pose(x + vx * duration, y + vy * duration, theta)

    def _repulsion(self, others: Sequence[Neighbour]) -> tuple[float, float]:
        """Return the acceleration away from players and walls, [m/s^2]."""
        x, y, _ = self.pose
        vx, vy = self._velocity
        fx = fy = 0.0
        people_only = self._settings.reaction == "avoid-people"
        for other in others:
            if people_only and not other.is_person:
                continue
            dx, dy = x - other.x, y - other.y
            away = hypot(dx, dy)
            if not 0.0 < away < 3.0:
                continue
            push = STRENGTH * exp((RADIUS + other.radius - away) / RANGE)
            if -(dx * vx + dy * vy) < 0.0:
                push *= BEHIND
            # Both give way to one side, or they would stop face to face.
            ux, uy = dx / away, dy / away
            fx += push * (ux - 0.3 * uy)
            fy += push * (uy + 0.3 * ux)
        if self._obstacles:
            gap = float(self._obstacles.clearance([(x, y)])[0])
            if gap < 1.0:
                nearest = int(self._obstacles.clearances([(x, y)])[0].argmin())
                out = self._obstacles.directions_out([(x, y)])[0, nearest]
                push = STRENGTH * exp(min((RADIUS - gap) / 0.15, 2.0))
                fx, fy = fx + push * out[0], fy + push * out[1]
        return float(fx), float(fy)
