"""Walk backward across the line of sight (paper, Sec. II-B)."""

from dataclasses import dataclass
from math import inf, pi, radians
from typing import NamedTuple

from .. import laws
from ..errors import ConfigurationError, check_positive, check_within
from ..planning import Direction
from .knowledge import STAND, Intent, Knowledge


class EvasionMemory(NamedTuple):
    """What an evader remembers.

    Attributes:
        evading: Whether it evades.
        side: On which side, +1 or -1, see :mod:`stepaside.laws`; 0 while it
            does not evade.
    """

    evading: bool = False
    side: int = 0


@dataclass(frozen=True, slots=True)
class Evasion:
    """Keep the line of sight at an angle, behind the own back.

    The side is chosen when evasion begins, and changes only when the
    pursuer is clearly seen on the other one.

    Attributes:
        angle: Strategy alpha, between the line of sight and where it walks,
            in [rad]: pi/2 moves aside, 0 moves back.
        saturated: Whether it turns by (6) instead of (4).
        safety_radius: Distance at which it begins, in [m].
        release_distance: Distance at which it ends, in [m].
        side_hysteresis: How far the bearing of the pursuer must be past 0
            or past pi for the side to change, in [rad]; from pi/2 on it
            never does.
    """

    angle: float = pi / 2
    saturated: bool = False
    safety_radius: float = 0.8
    release_distance: float = inf
    side_hysteresis: float = radians(20.0)

    def __post_init__(self) -> None:
        """Refuse what no evader can do."""
        error = ConfigurationError
        check_within(self.angle, 0.0, pi, "angle", "rad", error)
        check_positive(self.safety_radius, "safety_radius", "m", error)
        check_within(
            self.side_hysteresis, 0.0, pi, "side_hysteresis", "rad", error
        )
        if not self.release_distance > self.safety_radius:
            raise ConfigurationError(
                "release_distance must exceed safety_radius, "
                f"{self.safety_radius:g} [m], or evasion stops and starts, "
                f"got {self.release_distance}"
            )

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
