"""Rules of a game of two strategies without physics."""

from dataclasses import dataclass, replace
from math import pi

from ..core.constants import CAPTURE_DISTANCE
from ..core.errors import check_bearing, check_positive, check_within
from ..theory.unicycle.unicycle_game import Unicycle
from .knowledge import Limits


@dataclass(frozen=True, slots=True)
class StepGame:
    """Rules of a game by footsteps; times are path times."""

    stride: float = 0.04  # length of a step [m]
    speed: float = 0.1  # speed of the template [m/s]
    gain: float = 0.2  # steering gain k of both [1/s]
    # largest turn of a step [rad]; by default that of eq. (2), pi times gain
    # times stride over speed
    largest_turn: float | None = None
    capture: float = CAPTURE_DISTANCE  # distance of a capture [m]
    body_radius: float = 0.2  # least clearance of the evader [m]
    solid_pursuer: bool = False  # whether obstacles stop it
    duration: float = 180.0  # duration of a game [s]
    decisions: int = 1  # per step; with more, like unicycles
    pursuer_speed_ratio: float = 1.0  # also of strides
    pursuer_gain_ratio: float = 1.0  # of the steering

    def __post_init__(self) -> None:
        """Validate the rules."""
        check_positive(self.stride, "stride", "m")
        check_positive(self.speed, "speed", "m/s")
        check_positive(self.gain, "gain", "1/s")
        check_positive(self.capture, "capture", "m")
        check_positive(self.body_radius, "body_radius", "m")
        check_positive(self.duration, "duration", "s")
        check_within(self.decisions, 1, 100, "decisions", "1")
        for name in ("pursuer_speed_ratio", "pursuer_gain_ratio"):
            check_within(getattr(self, name), 0.1, 10.0, name, "1")
        if self.largest_turn is not None:
            check_positive(self.largest_turn, "largest_turn", "rad")
            check_bearing(self.largest_turn, "largest_turn")

    @classmethod
    def of_unicycles(
        cls,
        pursuer: Unicycle,
        evader: Unicycle,
        period: float,
        duration: float,
        capture: float = 1e-6,
    ) -> "StepGame":
        """Return the rules of unicycles that decide with a period, in [s].

        The game ends at a distance of capture [m] or after a duration [s].
        """
        check_positive(period, "period", "s")
        return cls(
            evader.speed * period,
            evader.speed,
            evader.gain,
            capture=capture,
            duration=duration,
            pursuer_speed_ratio=pursuer.speed / evader.speed,
            pursuer_gain_ratio=pursuer.gain / evader.gain,
        )

    @property
    def period(self) -> float:
        """Duration of a step, in [s]."""
        return self.stride / self.speed

    @property
    def share(self) -> float:
        """Turn of a step per desired heading, kappa."""
        return self.gain * self.period

    @property
    def turn(self) -> float:
        """Largest turn of a step, in [rad]."""
        if self.largest_turn is None:
            return pi * self.share
        return self.largest_turn

    @property
    def limits(self) -> tuple[Limits, Limits]:
        """Limits of the gaits of pursuer and evader."""
        evader = Limits(self.speed, self.gain, self.stride, self.period)
        ratio = self.pursuer_speed_ratio
        pursuer = replace(
            evader,
            speed=ratio * self.speed,
            stride=ratio * self.stride,
            gain=self.pursuer_gain_ratio * self.gain,
        )
        return pursuer, evader

    @property
    def count(self) -> int:
        """Number of decisions of a game."""
        return max(1, round(self.duration * self.decisions / self.period))

    @property
    def whole_duration(self) -> float:
        """Duration of all decisions of a game, in [s]."""
        return self.count * self.period / self.decisions
