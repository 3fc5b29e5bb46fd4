"""Pushes of robots, and their forces."""

import re
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, cos, pi, sin
from typing import TYPE_CHECKING, Any, NamedTuple

from ..core.errors import ConfigurationError, shown
from ..core.ranges import Range
from ..core.setting import REQUIRED, CheckedSettings, setting

if TYPE_CHECKING:
    import mujoco

MOST_PUSHES = 1000  # in one game
MAX_STORED = 1000  # pushes; a live game may run without end


@dataclass(frozen=True, slots=True)
class Push(CheckedSettings, prefix="push "):
    """Constant horizontal force at the torso for a short time."""

    impulse: float = setting(
        REQUIRED,
        "Impulse: force times duration",
        Range(0.0, 1000.0, "N s", "far beyond what a humanoid survives"),
    )
    time: float = setting(
        REQUIRED,
        "Time at which it begins",
        Range(0.0, 86400.0, "s", "the longest walk"),
    )
    direction: float = setting(
        REQUIRED,
        "Direction of the force relative to the robot's heading at that time "
        "{unit}: 0 forward, pi/2 to the left",
        Range(-2 * pi, 2 * pi, "rad", "a full turn"),
    )
    duration: float = setting(
        0.1, "Duration", Range(1e-4, 100.0, "s", "at least a physics step")
    )
    player: str = setting(
        "",
        "Name of the pushed robot; by default the walker, or the evader of a "
        "duel",
    )

    @classmethod
    def from_text(cls, text: str) -> "Push":
        """Return the push of a text: 1.2@5:90deg is 1.2 N s at 5 s, left.

        The player may precede it, as in ``pursuer=1.2@5:90deg``.
        """
        parts = _SYNTAX.fullmatch(text)
        if parts is None:
            raise ConfigurationError(
                "a push must be [PLAYER=]IMPULSE@TIME:DIRECTION [N s, s, "
                f"angle] like 1.2@5:90deg, got {shown(text)}"
            )
        return cls(
            _number(parts["impulse"]),
            _number(parts["time"]),
            _number(parts["direction"]),
            player=parts["player"] or "",
        )


_SYNTAX = re.compile(
    r"(?:(?P<player>[a-z]+)=)?(?P<impulse>[^@=]+)@(?P<time>[^:]+):"
    r"(?P<direction>.+)"
)


def _number(text: str) -> Any:
    """Return a number; any other text as it is, for the checks of fields."""
    try:
        return float(text)
    except ValueError:
        return text


class ScheduledPush(NamedTuple):
    """Push with its impulse in the world."""

    time: float  # start time [s]
    duration: float  # [s]
    x: float  # position of the torso at the start, x in the world [m]
    y: float  # position of the torso at the start, y in the world [m]
    impulse_x: float  # impulse along x of the world [N s]
    impulse_y: float  # impulse along y of the world [N s]


def pushes_by_robot(
    pushes: Sequence[Push], robots: Sequence[str]
) -> dict[str, tuple[Push, ...]]:
    """Group pushes by the name of the robot, by default the last."""
    return {
        name: tuple(p for p in pushes if (p.player or robots[-1]) == name)
        for name in robots
    }


class PushApplier:
    """Pushes of one body: total impulse [N s], and the latest pushes."""

    def __init__(
        self, model: "mujoco.MjModel", data: "mujoco.MjData", torso: int
    ) -> None:
        self._force = data.xfrc_applied[torso]
        self._frame = data.xmat[torso]
        self._position = data.xpos[torso]
        self._time_step = model.opt.timestep
        self._scheduled: list[Push] = []
        self._active: list[tuple[float, float, float]] = []
        self.impulse = (0.0, 0.0)
        self.given: deque[ScheduledPush] = deque(maxlen=MAX_STORED)

    def add(self, push: Push) -> None:
        """Schedule a push."""
        self._scheduled = sorted(
            [*self._scheduled, push], key=lambda push: push.time
        )

    def before_step(self, time: float) -> None:
        """Set the force for the physics step that starts at a time, [s]."""
        if not self._scheduled and not self._active:
            return
        while self._scheduled and self._scheduled[0].time <= time + 1e-9:
            self._start(self._scheduled.pop(0), time)
        self._active = [a for a in self._active if a[0] > time + 1e-9]
        fx = sum(a[1] for a in self._active)
        fy = sum(a[2] for a in self._active)
        self._force[0], self._force[1] = fx, fy
        given, h = self.impulse, self._time_step
        self.impulse = given[0] + fx * h, given[1] + fy * h

    def _start(self, push: Push, time: float) -> None:
        """Start a push, in the direction of the torso's heading."""
        angle = atan2(self._frame[3], self._frame[0]) + push.direction
        force = push.impulse / push.duration
        fx, fy = force * cos(angle), force * sin(angle)
        self._active.append((time + push.duration, fx, fy))
        x, y, _ = self._position.tolist()
        whole = fx * push.duration, fy * push.duration
        self.given.append(ScheduledPush(time, push.duration, x, y, *whole))
