"""Walk backward across the line of sight (paper, Sec. II-B)."""

from dataclasses import dataclass, replace
from math import inf, pi, radians
from typing import ClassVar, Literal, NamedTuple, get_args

from ..core.errors import ConfigurationError
from ..core.ranges import Range, Ranges, check_settings
from ..planning import Direction
from ..theory import laws
from .approach import Approach, clearance_of, swift_heading
from .knowledge import STAND, Intent, Knowledge

Trigger = Literal["distance", "time"]
TRIGGERS: tuple[str, ...] = get_args(Trigger)
CALMER = 0.125  # from one pace that is tried to the next
SAFER = 1.25  # times the clearance that lets an evader come to rest


class EvasionMemory(NamedTuple):
    """What an evader remembers.

    Attributes:
        evading: Whether it evades.
        side: On which side, +1 or -1, see :mod:`stepaside.theory.laws`; 0
        while it
            does not evade.
        safe: Decisions in a row in which standing would have been safe.
    """

    evading: bool = False
    side: int = 0
    safe: int = 0


@dataclass(frozen=True, slots=True)
class Evasion:
    """Keep the line of sight at an angle, behind the own back.

    The side is chosen when evasion begins, and changes only when the
    pursuer is clearly seen on the other one.

    The safety area is one in space, as in the paper, or in time. In time the
    evader begins when somebody who walks straight on would be near it soon.
    It walks across the way that the other comes, turns as soon as its gait
    can, and keeps to the side that leaves more room until standing is safe.

    Attributes:
        angle: Strategy alpha, between the line of sight and where it walks, in
            [rad]: pi/2 moves aside, 0 moves back; 0 to 3.14159.
        saturated: Whether it turns by (6) instead of (4).
        safety_radius: Distance at which it begins, in [m]; 0.001 to 1e+09.
        release_distance: Distance at which it ends, in [m]; 0.001 to 1e+09 or
            inf.
        side_hysteresis: How far the bearing of the pursuer must be past 0 or
            past pi for the side to change, in [rad]; from pi/2 on it never
            does; 0 to 3.14159.
        trigger: Whether distance or time begins and ends it.
        contact_time: Time to contact at which it begins, in [s], if by time;
            half as much again ends it; 0.1 to 60.
        clearance: Distance that counts as contact then, in [m]; 0.1 to 10.
        calmest: Least pace then, see :class:`Intent`: it walks as calmly as
            leaves the other room, and hurries when it has to; 1 always
            hurries; 0.5 to 1.
    """

    angle: float = pi / 2
    saturated: bool = False
    safety_radius: float = 0.8
    release_distance: float = inf
    side_hysteresis: float = radians(20.0)
    trigger: Trigger = "distance"
    contact_time: float = 3.5
    clearance: float = 0.7
    calmest: float = 1.0

    ranges: ClassVar[Ranges] = {
        "angle": Range(0.0, pi, "rad", "the side says which way it is"),
        "safety_radius": Range(
            *(1e-3, 1e9, "m"),
            "a millimetre is contact; from the start on it always evades",
        ),
        "release_distance": Range(
            *(1e-3, 1e9, "m"), "and above safety_radius", also=(inf,)
        ),
        "side_hysteresis": Range(0.0, pi, "rad", "half a turn"),
        "contact_time": Range(0.1, 60.0, "s", "a step takes longer than less"),
        "clearance": Range(0.1, 10.0, "m", "bodies have some width"),
        "calmest": Range(0.5, 1.0, "1", "calmer, a step takes too long"),
    }

    def __post_init__(self) -> None:
        """Refuse what no evader can do."""
        check_settings(self)
        if not self.release_distance > self.safety_radius:
            raise ConfigurationError(
                "release_distance must exceed safety_radius, "
                f"{self.safety_radius:g} [m], or evasion stops and starts, "
                f"got {self.release_distance}"
            )
        if self.trigger not in TRIGGERS:
            raise ConfigurationError(
                f"trigger must be one of {', '.join(TRIGGERS)}, "
                f"got {self.trigger!r}"
            )

    @property
    def area(self) -> float:
        """Radius of what it keeps free around itself, in [m].

        In time that is what counts as contact: where evasion begins depends
        on how fast the other comes.
        """
        return self.clearance if self.trigger == "time" else self.safety_radius

    def begins_at(self, speed: float) -> float:
        """Distance at which it begins for who comes straight at it, in [m].

        Args:
            speed: With which the other comes, in [m/s].
        """
        ahead = self.contact_time * speed if self.trigger == "time" else 0.0
        return self.area + ahead

    @property
    def direction(self) -> Direction:
        """Backward, eq. (3)."""
        return Direction.BACKWARD

    def begin(self) -> EvasionMemory:
        """Not evading, on no side yet."""
        return EvasionMemory()

    def decide(
        self, knowledge: Knowledge, memory: EvasionMemory
    ) -> tuple[Intent, EvasionMemory]:
        """Stand until the other is near, then keep it at the angle, (5)."""
        if self.trigger == "time":
            return self._decide_in_time(knowledge, memory)
        if not laws.is_evading(
            memory.evading,
            knowledge.distance,
            self.safety_radius,
            self.release_distance,
        ):
            return STAND, EvasionMemory()
        bearing = knowledge.bearing
        side = laws.keep_side(memory.side, bearing, self.side_hysteresis)
        heading = laws.evasion_heading(bearing, side, self.angle)
        return Intent(heading), EvasionMemory(True, side)

    def _decide_in_time(
        self, knowledge: Knowledge, memory: EvasionMemory
    ) -> tuple[Intent, EvasionMemory]:
        """Step out of the way of somebody who would be near soon."""
        approach = Approach.of(knowledge)
        safe = 0
        if not memory.evading:
            if approach.contact_time(self.clearance) >= self.contact_time:
                return STAND, EvasionMemory()
        else:
            soon = approach.contact_time(SAFER * self.clearance)
            safe = memory.safe + 1 if soon > 1.5 * self.contact_time else 0
            if safe > 1:  # one that sways is safe for a moment
                return STAND, EvasionMemory()
        side = memory.side or self._clearer_side(knowledge, approach)
        error = laws.evasion_heading(approach.origin, side, self.angle)
        heading = swift_heading(error, knowledge.limits)
        pace = self._pace(knowledge, approach, error)
        return Intent(heading, pace=pace), EvasionMemory(True, side, safe)

    def _pace(
        self, knowledge: Knowledge, approach: Approach, error: float
    ) -> float:
        """Calmest pace that leaves the other its room."""
        limits, room = knowledge.limits, SAFER * self.clearance
        pace = self.calmest
        while pace < 1.0:
            slower = replace(limits, step_duration=limits.step_duration / pace)
            stands = not knowledge.moving
            if clearance_of(approach, slower, error, stands=stands) > room:
                return pace
            pace += CALMER
        return 1.0

    def _clearer_side(self, knowledge: Knowledge, approach: Approach) -> int:
        """Side that leaves more room; who changes it loses what it made."""
        left, right = (
            clearance_of(
                approach,
                knowledge.limits,
                laws.evasion_heading(approach.origin, side, self.angle),
                stands=not knowledge.moving,
            )
            for side in (1, -1)
        )
        if abs(left - right) < 1e-9:
            return laws.side_behind(approach.origin)
        return 1 if left > right else -1
