"""A family of pursuers with the paper's law and four parameters."""

from dataclasses import dataclass, replace
from math import atan2, cos, hypot, pi, sin, tau

from ..core.poses import wrap_angle
from ..core.ranges import Range
from ..core.setting import check_settings, setting
from ..planning import Direction
from .knowledge import Intent, Knowledge
from .pursuit import Pursuit

NEAR = 1e-6  # distance from the centre at which it has no bearing, in [m]


@dataclass(frozen=True, slots=True)
class ParametricPursuit:
    """Pursuer that heads between the evader and the centre, and sways.

    Without pull and sway it is the paper's pursuer of another gain, with a
    pull of 1 :class:`HerdingPursuit` of another gain.
    """

    gain_ratio: float = setting(
        1.0,
        "Steering gain over that of the gait",
        Range(0.0, 1e3, "1", "it turns to its target", above=True),
    )
    pull: float = setting(
        0.0,
        "Weight of the direction of the centre of the room; that of the "
        "evader has weight 1",
        Range(-10.0, 10.0, "1", "beyond, it forgets the evader"),
    )
    sway: float = setting(
        0.0,
        "Amplitude of a periodic error of its bearing",
        Range(0.0, pi, "rad", "half a turn"),
    )
    period: float = setting(
        10.0,
        "Period of that error",
        Range(0.1, 1e3, "s", "it is periodic"),
    )

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_settings(self)

    @property
    def direction(self) -> Direction:
        """Forward, eq. (1)."""
        return Direction.FORWARD

    @property
    def saturated(self) -> bool:
        """False: it turns by (8)."""
        return False

    def begin(self) -> int | None:
        """Return the side of a detour: none yet."""
        return None

    def decide(
        self, knowledge: Knowledge, memory: int | None
    ) -> tuple[Intent, int | None]:
        """Head for the target, with the error of this time."""
        x, y, theta = knowledge.pose_in_map
        sight, inward = theta + knowledge.bearing, hypot(x, y)
        dx, dy = cos(sight), sin(sight)
        if inward > NEAR:
            dx -= self.pull * x / inward
            dy -= self.pull * y / inward
        error = self.sway * sin(tau * knowledge.time / self.period)
        aimed = replace(
            knowledge, bearing=wrap_angle(atan2(dy, dx) - theta + error)
        )
        return Pursuit(gain_ratio=self.gain_ratio).decide(aimed, memory)
