"""Walk of a person to a goal among other players.

It follows the social force model. Reactions to robots are those of the
simulator HuNavSim (N. Perez-Higueras et al., IEEE Robotics and Automation
Letters 8, 2023), with its distances, durations and forces.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, cos, exp, hypot, pi, radians, sin, tanh
from typing import NamedTuple

from ..arena import NO_OBSTACLES, ObstacleSet
from ..core.poses import Pose, wrap_angle
from .person_settings import RADIUS, CrowdSettings

RELAXATION = 0.5  # time to reach the desired velocity, in [s]
STRENGTH = 5.1  # of the force from another walker, in [m/s^2]
ANTICIPATION = 2.0  # weight of the relative velocity, in [s/m]
REACH = 0.35  # of the force per magnitude of the interaction, in [m]
NARROWING = 3.0  # of deceleration with the angle, in [1/(m rad)]
TURNING = 2.0  # likewise of turning aside
PREFERENCE = 0.005  # for passing on the right, in [rad/m]
OBSTACLE = 10.0  # force at contact with an obstacle, in [m/s^2]
OBSTACLE_RANGE = 0.2  # in which it decays by e, in [m]
COHESION = 3.0  # force towards the middle of a group, in [m/s^2]
SPACING = 0.55  # distance below which members of a group part, in [m]
Vector = tuple[float, float]


def social_force(
    offset: Vector, relative_velocity: Vector, preference: float = PREFERENCE
) -> Vector:
    """Return the acceleration [m/s^2] of a walker by another one.

    Offset and velocity are relative to the other. Both tend to the right by
    the preference; without, two who meet head-on only slow down.
    """
    distance = hypot(*offset)
    if distance == 0.0:
        return 0.0, 0.0
    x = offset[0] / distance - ANTICIPATION * relative_velocity[0]
    y = offset[1] / distance - ANTICIPATION * relative_velocity[1]
    interaction = hypot(x, y)
    reach = REACH * interaction
    if reach == 0.0:
        return 0.0, 0.0
    along = atan2(y, x)
    angle = wrap_angle(along - atan2(offset[1], offset[0]))
    angle -= reach * preference
    decay = -distance / reach
    slows = STRENGTH * exp(decay - (NARROWING * reach * angle) ** 2)
    turns = STRENGTH * exp(decay - (TURNING * reach * angle) ** 2)
    turns = -turns if angle > 0.0 else turns if angle < 0.0 else 0.0
    c, s = cos(along), sin(along)
    return slows * c - turns * s, slows * s + turns * c


def desired_force(
    offset: Vector, velocity: Vector, speed: float, halts_within: float
) -> Vector:
    """Return the acceleration [m/s^2] towards a goal at an offset [m]."""
    distance = hypot(*offset)
    scale = speed / distance if distance > halts_within else 0.0
    return (
        (scale * offset[0] - velocity[0]) / RELAXATION,
        (scale * offset[1] - velocity[1]) / RELAXATION,
    )


def obstacle_force(outward: Vector, gap: float) -> Vector:
    """Return the acceleration [m/s^2] away from an obstacle at a gap [m]."""
    push = OBSTACLE * exp(-max(gap, 0.0) / OBSTACLE_RANGE)
    return push * outward[0], push * outward[1]


def group_force(place: Vector, members: list[Vector]) -> Vector:
    """Return the acceleration [m/s^2] of a walker by its group."""
    if not members:
        return 0.0, 0.0
    count = len(members) + 1
    x = (place[0] + sum(m[0] for m in members)) / count - place[0]
    y = (place[1] + sum(m[1] for m in members)) / count - place[1]
    scale = 0.5 * COHESION * (1.0 + tanh(hypot(x, y) - 0.5 * (count - 1)))
    x, y = scale * x, scale * y
    for member in members:
        dx, dy = place[0] - member[0], place[1] - member[1]
        if hypot(dx, dy) < SPACING:
            x, y = x + dx, y + dy
    return x, y


class Notice(NamedTuple):
    """When a person notices a robot, and for how long it reacts."""

    within: float  # greatest distance [m]
    lasts: float  # duration of the reaction [s]


NOTICES = {
    "surprised": Notice(4.0, 30.0),
    "curious": Notice(10.0, 30.0),
    "scared": Notice(3.0, 40.0),
    "threatening": Notice(4.0, 40.0),
}
VIEW = radians(100.0)  # to either side, within which it notices a robot
ARRIVED = 0.2  # distance from the goal at which the person halts, in [m]
FASTEST = 1.3  # greatest speed over the desired one
FAR = 8.0  # distance beyond which others have no influence, in [m]
WALL_FORCE_WITHIN = 1.0  # gap to a wall, in [m]
NEAR_ENOUGH = 1.5  # distance at which a curious person halts, in [m]
APPROACH_RATE = 0.18  # speed of a curious person per distance, in [1/s]
BLOCKING = 1.1  # ahead of the robot, where a threatening one stands, in [m]
SCARED_SPEED = 0.6  # greatest speed of a scared person, in [m/s]
SCARE = 20.0  # force on a scared person at OBSTACLE_RANGE, in [m/s^2]
TURN_RATE = pi  # of a person who turns to look at a robot, in [rad/s]
SMOOTHING = 0.3  # time constant of the velocities of others, in [s]
LOOKS_WITHIN = 1.2  # distance of a robot that a person looks at, in [m]
STANDING = 0.1  # speed below which a robot stands, in [m/s]


@dataclass(frozen=True, slots=True)
class Neighbour:
    """Another player, as a person sees it."""

    x: float  # position in the world [m]
    y: float
    is_person: bool
    radius: float = RADIUS  # radius of its body [m]
    is_companion: bool = False  # whether it walks in the same group


class CrowdMotion:
    """Walk of a person to a goal, integrated step by step."""

    def __init__(
        self,
        settings: CrowdSettings,
        start: Pose,
        goal: Vector,
        obstacles: ObstacleSet = NO_OBSTACLES,
    ) -> None:
        self._settings, self._obstacles = settings, obstacles
        self.pose = start
        self._goals = [goal, start[:2]]
        self._velocity = 0.0, 0.0
        self._seen: Sequence[Neighbour] = ()
        self._velocities: list[Vector] = []
        self._reacted = 0.0
        self.arrived_at: float | None = None

    def advance(
        self, time: float, duration: float, others: Sequence[Neighbour]
    ) -> None:
        """Advance by a step [s]; the order of the others never changes."""
        self._observe(others, duration)
        x, y, theta = self.pose
        gx, gy = self._goals[0]
        if hypot(gx - x, gy - y) < ARRIVED:
            if self.arrived_at is None:
                self.arrived_at = time
            if self._settings.returns:
                self._goals.reverse()
        noticed = self._noticed()
        if noticed is not None:
            self._reacted += duration
        goal, speed = self._intention(noticed)
        vx, vy = self._velocity
        toward = goal[0] - x, goal[1] - y
        ax, ay = desired_force(toward, self._velocity, speed, ARRIVED)
        fx, fy = self._forces(noticed)
        vx, vy = vx + (ax + fx) * duration, vy + (ay + fy) * duration
        pace, most = hypot(vx, vy), FASTEST * self._settings.speed
        if pace > most:
            vx, vy = vx * most / pace, vy * most / pace
        self._velocity = vx, vy
        robot = None if noticed is None else others[noticed]
        if robot is not None and (
            speed == 0.0 or hypot(robot.x - x, robot.y - y) < LOOKS_WITHIN
        ):
            sight = wrap_angle(atan2(robot.y - y, robot.x - x) - theta)
            most = TURN_RATE * duration
            theta = wrap_angle(theta + min(max(sight, -most), most))
        elif hypot(vx, vy) > 0.05:
            theta = atan2(vy, vx)
        self.pose = Pose(x + vx * duration, y + vy * duration, theta)

    def _observe(self, others: Sequence[Neighbour], duration: float) -> None:
        """Update the velocities of the other players."""
        if len(self._seen) != len(others):
            self._velocities = [(0.0, 0.0)] * len(others)
        else:
            # Robots sway at each step, which is no motion to react to.
            share = duration / (SMOOTHING + duration)
            self._velocities = [
                (
                    u + share * ((now.x - was.x) / duration - u),
                    v + share * ((now.y - was.y) / duration - v),
                )
                for (u, v), now, was in zip(
                    self._velocities, others, self._seen, strict=True
                )
            ]
        self._seen = others

    def _noticed(self) -> int | None:
        """Return the number of the robot that the person reacts to."""
        notice = NOTICES.get(self._settings.reaction)
        if notice is None or self._reacted > notice.lasts:
            return None
        x, y, theta = self.pose
        found: list[tuple[float, int]] = []
        for i, other in enumerate(self._seen):
            dx, dy = other.x - x, other.y - y
            angle = abs(wrap_angle(atan2(dy, dx) - theta))
            distance = hypot(dx, dy)
            in_view = distance <= notice.within and angle <= VIEW
            if in_view and not other.is_person:
                found.append((distance, i))
        return min(found)[1] if found else None

    def _intention(self, noticed: int | None) -> tuple[Vector, float]:
        """Return goal, in [m], and desired speed, in [m/s]."""
        settings = self._settings
        goal, speed = self._goals[0], settings.speed
        if noticed is None:
            return goal, speed
        robot, (x, y, _) = self._seen[noticed], self.pose
        distance = hypot(robot.x - x, robot.y - y)
        if settings.reaction == "surprised":
            return goal, 0.0
        if settings.reaction == "scared":
            return goal, min(speed, SCARED_SPEED)
        if settings.reaction == "curious":
            slow = APPROACH_RATE * distance if distance > NEAR_ENOUGH else 0.0
            return (robot.x, robot.y), min(speed, slow)
        u, v = self._velocities[noticed]
        ahead = (
            atan2(v, u)
            if hypot(u, v) > STANDING
            else atan2(y - robot.y, x - robot.x)
        )
        dx, dy = BLOCKING * cos(ahead), BLOCKING * sin(ahead)
        return (robot.x + dx, robot.y + dy), speed

    def _forces(self, noticed: int | None) -> Vector:
        """Return the acceleration by players and walls, in [m/s^2]."""
        x, y, _ = self.pose
        fx = fy = 0.0
        reaction = self._settings.reaction
        others = zip(self._seen, self._velocities, strict=True)
        for other, (u, v) in others if reaction != "none" else ():
            offset = x - other.x, y - other.y
            away = hypot(*offset)
            if not 0.0 < away < FAR:
                continue
            if other.is_person or self._is_regular:
                vx, vy = self._velocity
                ax, ay = social_force(offset, (vx - u, vy - v))
            elif reaction == "impassive":
                outward = offset[0] / away, offset[1] / away
                gap = away - RADIUS - other.radius
                ax, ay = obstacle_force(outward, gap)
            else:
                continue
            fx, fy = fx + ax, fy + ay
        if noticed is not None and reaction == "scared":
            robot = self._seen[noticed]
            dx, dy = x - robot.x, y - robot.y
            away = hypot(dx, dy)
            push = SCARE * OBSTACLE_RANGE / max(away - RADIUS, 0.1)
            fx, fy = fx + push * dx / away, fy + push * dy / away
        companions = [(o.x, o.y) for o in self._seen if o.is_companion]
        ax, ay = group_force((x, y), companions)
        wx, wy = self._wall_force()
        return fx + ax + wx, fy + ay + wy

    @property
    def _is_regular(self) -> bool:
        """Whether robots are like people for this person."""
        notice = NOTICES.get(self._settings.reaction)
        if notice is None:
            return self._settings.reaction == "regular"
        return self._reacted > notice.lasts

    def _wall_force(self) -> Vector:
        """Return the acceleration away from the nearest wall, [m/s^2]."""
        x, y, _ = self.pose
        if self._settings.reaction == "none" or not self._obstacles:
            return 0.0, 0.0
        gaps = self._obstacles.clearances([(x, y)])[0]
        nearest = int(gaps.argmin())
        gap = float(gaps[nearest])
        if gap >= WALL_FORCE_WITHIN:
            return 0.0, 0.0
        out = self._obstacles.directions_out([(x, y)])[0, nearest]
        outward = float(out[0]), float(out[1])
        return obstacle_force(outward, gap - RADIUS)
