"""Pursuit: head for the evader (paper, Sec. II-A), and variations of it."""

from dataclasses import dataclass, replace
from math import atan2, cos, hypot, inf, pi, sin
from typing import ClassVar, NamedTuple

from .. import arena
from ..arena import BODY_RADIUS
from ..core.poses import wrap_angle
from ..core.random_streams import named_generator
from ..core.ranges import SEEDS, Range
from ..core.setting import CheckedSettings, setting
from ..planning import Direction
from ..theory import laws
from .knowledge import BODY, STAND, Intent, Knowledge
from .opponent_track import OpponentTrack, track_of_steps

FREE_STRIDES = 3.0  # straight ahead that allow turning by (2)
NEAR = 1e-6  # distance from the centre at which it has no bearing, in [m]


class PursuitMemory(NamedTuple):
    """Memory of a pursuer."""

    side: int = 0  # side of the present detour, 1 left or -1 right; 0 for none
    track: OpponentTrack | None = None  # if a course is needed


@dataclass(frozen=True, slots=True)
class Pursuit(CheckedSettings):
    """The paper's pursuer: head for the evader; and a family around it.

    With known obstacles it heads for the first vertex of the shortest path.
    With a pull it heads between the evader and the centre of the room, which
    is the origin of a known room, else the own initial pose; at 1 for the
    bisector of both bearings, so that it drives the evader to the walls. With
    a lead it heads for a point ahead of the evader on its course.
    """

    direction: ClassVar = Direction.FORWARD
    saturated: bool = setting(False, "Turn by eq. (6) instead of eq. (8)")
    body_radius: float = setting(
        BODY_RADIUS, "Clearance of the path from obstacles", BODY
    )
    gain: float = setting(
        1.0,
        "Steering gain over that of the gait {unit}. Turns are limited to "
        "what eq. (2) gives at the gait's gain, k pi: inf turns by the whole "
        "bearing in one step, up to that limit",
        Range(
            0.0, 1e3, "1", "it turns to the evader", above=True, also=(inf,)
        ),
    )
    pull: float = setting(
        0.0,
        "Weight of the direction of the centre of the room; that of the "
        "evader has weight 1",
        Range(-10.0, 10.0, "1", "beyond, it forgets the evader"),
    )
    lead: float = setting(
        0.0,
        "Distance of its target ahead of the evader, over the distance "
        "between the players",
        Range(0.0, 10.0, "1", "beyond, it forgets the evader"),
    )
    noise: float = setting(
        0.0,
        "Standard deviation of a random error of its bearing in each step",
        Range(0.0, 10.0, "rad", "more than a turn is no bearing"),
    )
    seed: int = setting(0, "Seed of the random errors", SEEDS)
    walking: float = setting(
        10.0,
        "Time for which it pursues before it waits",
        Range(0.0, 1e6, "s", "it pursues", above=True),
    )
    waiting: float = setting(
        0.0,
        "Time for which it stands again and again",
        Range(0.0, 1e6, "s", "0 never waits"),
    )

    def begin(self) -> PursuitMemory:
        """Return the memory before the first sighting."""
        return PursuitMemory()

    def decide(
        self, knowledge: Knowledge, memory: PursuitMemory
    ) -> tuple[Intent, PursuitMemory]:
        """Head for the target by eq. (2), or along the path to it."""
        if self.lead:
            track = track_of_steps(memory.track, knowledge)
            memory = memory._replace(track=track)
        cycle = self.walking + self.waiting
        if self.waiting and knowledge.time % cycle >= self.walking:
            return STAND, memory
        seen, side = knowledge, 0
        if self.lead or self.pull or self.noise:
            seen = self._aimed(knowledge, memory.track)
        bearing, bends = seen.bearing, False
        if seen.knows_obstacles:
            bearing, side, bends = self.course(seen, memory.side)
        if side != memory.side:
            memory = memory._replace(side=side)
        if bends:
            # By (2) it would turn too slowly and walk into the obstacle.
            return Intent(seen.limits.correcting_heading(bearing)), memory
        # A step turns by a fraction of it, which depends on the gait.
        ratio = min(self.gain, max(1.0, 1.0 / seen.limits.share))
        heading = ratio * laws.pursuit_heading(bearing)
        return Intent(min(max(heading, -pi), pi)), memory

    def _aimed(
        self, knowledge: Knowledge, track: OpponentTrack | None
    ) -> Knowledge:
        """Return the knowledge with the target as the opponent."""
        course = track.course if track else None
        if course is not None:
            ahead = course - knowledge.pose_in_map.theta
            reach, (x, y) = self.lead * knowledge.distance, knowledge.position
            knowledge = knowledge.towards(
                x + reach * cos(ahead), y + reach * sin(ahead)
            )
        x, y, theta = knowledge.pose_in_map
        inward = hypot(x, y)
        if self.pull and inward > NEAR:
            sight, away = theta + knowledge.bearing, knowledge.distance
            dx = cos(sight) - self.pull * x / inward
            dy = sin(sight) - self.pull * y / inward
            # The target divides the way from the evader to the centre.
            way = away * inward / (inward + abs(self.pull) * away)
            knowledge = replace(
                knowledge,
                bearing=wrap_angle(atan2(dy, dx) - theta),
                distance=hypot(dx, dy) * way,
            )
        if self.noise:
            step = round(knowledge.time / knowledge.limits.step_duration)
            stream = named_generator(self.seed, f"noisy-pursuit/{step}")
            error = min(max(self.noise * stream.normal(), -pi), pi)
            bearing = wrap_angle(knowledge.bearing + error)
            knowledge = replace(knowledge, bearing=bearing)
        return knowledge

    def course(
        self, knowledge: Knowledge, side: int = 0
    ) -> tuple[float, int, bool]:
        """Return bearing [rad] and side of the path, and whether it bends."""
        return arena.course_around(
            knowledge.obstacles_in_map,
            knowledge.pose_in_map,
            knowledge.position_in_map,
            self.body_radius,
            side,
            FREE_STRIDES * knowledge.limits.stride,
        )
