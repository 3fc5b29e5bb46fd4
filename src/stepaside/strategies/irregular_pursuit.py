"""Pursuers that do not keep to one law: they wait, or turn at random."""

from dataclasses import dataclass, field, replace
from math import pi

from ..core.errors import (
    ConfigurationError,
    check_not_negative,
    check_positive,
)
from ..core.poses import wrap_angle
from ..core.random_streams import named_generator
from .knowledge import STAND, Intent, Knowledge
from .pursuit import Pursuit, PursuitVariant

ERROR = ConfigurationError


@dataclass(frozen=True, slots=True)
class WaitingPursuit(PursuitVariant):
    """The paper's pursuer, which stops and waits again and again.

    Attributes:
        walking: Time for which it pursues, in [s].
        waiting: Time for which it stands afterwards, in [s].
        pursuit: Pursuit in between.
    """

    walking: float = 10.0
    waiting: float = 5.0
    pursuit: Pursuit = field(default_factory=Pursuit)

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_positive(self.walking, "walking", "s", ERROR)
        check_not_negative(self.waiting, "waiting", "s", ERROR)

    def decide(
        self, knowledge: Knowledge, memory: int | None
    ) -> tuple[Intent, int | None]:
        """Pursue, or stand while it waits."""
        phase = knowledge.time % (self.walking + self.waiting)
        if phase >= self.walking:
            return STAND, memory
        return self.pursuit.decide(knowledge, memory)


@dataclass(frozen=True, slots=True)
class NoisyPursuit(PursuitVariant):
    """The paper's pursuer with a random error of its bearing.

    Attributes:
        deviation: Standard deviation of the error, in [rad].
        seed: Seed of the errors, one per step.
        pursuit: Pursuit by the wrong bearing.
    """

    deviation: float = 0.5
    seed: int = 0
    pursuit: Pursuit = field(default_factory=lambda: Pursuit(gain_ratio=2.0))

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_not_negative(self.deviation, "deviation", "rad", ERROR)

    def decide(
        self, knowledge: Knowledge, memory: int | None
    ) -> tuple[Intent, int | None]:
        """Pursue by the bearing with the error of this step."""
        step = round(knowledge.time / knowledge.limits.step_duration)
        generator = named_generator(self.seed, f"noisy-pursuit/{step}")
        error = min(max(self.deviation * generator.normal(), -pi), pi)
        seen = replace(
            knowledge, bearing=wrap_angle(knowledge.bearing + error)
        )
        return self.pursuit.decide(seen, memory)
