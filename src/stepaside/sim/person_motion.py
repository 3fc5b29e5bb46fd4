"""Where a person walks."""

import csv
from collections.abc import Callable
from math import atan2, cos, inf, pi, sin
from pathlib import Path

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array, Pose, wrap_angle
from ..theory import laws
from .person_settings import PATHS, PersonSettings
from .person_visits import RepeatedVisits

Place = tuple[float, float]


class PersonMotion:
    """A walk, step by step.

    Attributes:
        pose: Where the person is and faces, in the world.
        visits: Of somebody who comes and goes.
    """

    def __init__(
        self, settings: PersonSettings, start: Pose, evader: Place
    ) -> None:
        """Begin a walk.

        Args:
            settings: How the person walks.
            start: Where the walk begins; a recorded path begins where it
                says itself.
            evader: Place of the evader then, in [m].

        Raises:
            ConfigurationError: If a recorded path cannot be read.
        """
        self._settings = settings
        self._recorded: Array | None = None
        heading = start.theta
        if settings.path in ("straight", "visits"):
            away = atan2(evader[1] - start.y, evader[0] - start.x)
            aim = (
                evader[0] - settings.miss * sin(away),
                evader[1] + settings.miss * cos(away),
            )
            heading = atan2(aim[1] - start.y, aim[0] - start.x)
        self._course = heading
        self.visits = RepeatedVisits(settings.miss)
        self._way, self._turned = 0.0, False
        self.pose = self._facing(start.x, start.y)
        if settings.path not in PATHS:
            self._recorded = read_path(Path(settings.path))
            self.pose = self._at(0.0)

    def advance(self, time: float, duration: float, evader: Place) -> None:
        """Walk on.

        Args:
            time: Time at the end of the step, in [s].
            duration: Of the step, in [s].
            evader: Place of the evader, in [m].
        """
        if self._recorded is not None:
            self.pose = self._at(time)
            return
        x, y, _ = self.pose
        settings = self._settings
        way = settings.speed * duration
        if self._way + 0.5 * way > settings.halt_after:
            return
        if not self._turned and self._way + 0.5 * way > settings.turn_after:
            self._turned = True
            self._course += settings.turn
        if settings.path == "visits":
            self._course = self.visits.course((x, y), self._course, evader)
        if settings.path == "steer":
            # (1)-(2) of the paper, held over one tick.
            sight = atan2(evader[1] - y, evader[0] - x)
            aim = laws.pursuit_heading(wrap_angle(sight - self._course))
            rate = laws.proportional_rate(aim, settings.gain)
            self._course += rate * duration
        self._way += way
        course = self._course
        self.pose = self._facing(x + way * cos(course), y + way * sin(course))

    def _facing(self, x: float, y: float) -> Pose:
        """Somewhere, facing where the walk goes or away from it."""
        if self._settings.backward:
            return Pose(x, y, wrap_angle(self._course + pi))
        return Pose(x, y, self._course)

    def _at(self, time: float) -> Pose:
        assert self._recorded is not None
        times, x, y = self._recorded.T
        later = min(time, float(times[-1]) - 0.1) + 0.1
        u = np.interp([time, later - 0.1, later], times, x)
        v = np.interp([time, later - 0.1, later], times, y)
        here = float(u[0]), float(v[0])
        dx, dy = float(u[2] - u[1]), float(v[2] - v[1])
        heading = atan2(dy, dx) if (dx, dy) != (0.0, 0.0) else 0.0
        return Pose(*here, heading)


def read_path(file: Path) -> Array:
    """Read a recorded path.

    Returns:
        Rows of time [s], x [m] and y [m]. Shape (n, 3).

    Raises:
        ConfigurationError: If it is no such file.
    """
    try:
        with file.open(encoding="utf-8", newline="") as lines:
            rows = list(csv.reader(lines))
        if not rows or [c.strip() for c in rows[0]] != ["time", "x", "y"]:
            raise ValueError("its first line is not time,x,y")
        table = np.array([[float(cell) for cell in row] for row in rows[1:]])
    except (OSError, ValueError) as error:
        raise ConfigurationError(
            f"person.path must be {', '.join(PATHS)} or a CSV file of "
            f"time,x,y [s, m, m], got {str(file)!r}: {error}"
        ) from error
    if table.ndim != 2 or table.shape[0] < 2 or table.shape[1] != 3:
        raise ConfigurationError(
            f"a recorded path needs two rows of time,x,y [s, m, m], {file} "
            f"has {max(0, len(rows) - 1)}"
        )
    if not (np.isfinite(table).all() and (np.diff(table[:, 0]) > 0.0).all()):
        raise ConfigurationError(
            f"times of a recorded path must be finite and rise [s], {file} "
            "does not keep that"
        )
    return table


def template_approach(
    motion: Callable[[Pose, Place], PersonMotion],
    start: Pose,
    evader: Pose,
    *,
    speed: float,
    gain: float,
    angle: float,
    safety_radius: float,
    duration: float,
    step: float = 0.01,
) -> float:
    """Closest approach of the person to the template of the evader.

    The evader is a unicycle in gait time: it stands until the person is in
    the safety area, and then walks backward across the line of sight.

    Args:
        motion: Begins a walk of the person.
        start: Where it begins.
        evader: Where the evader stands and heads.
        speed: Of the evader, in [m/s] of real time.
        gain: Of its turning, in [1/s] of real time.
        angle: Its strategy, in [rad].
        safety_radius: In [m].
        duration: How long to look, in [s].
        step: Of the integration, in [s].

    Returns:
        Least distance, in [m].
    """
    x, y, theta = evader
    walk = motion(start, (x, y))
    side = 0
    least = float(np.hypot(walk.pose.x - x, walk.pose.y - y))
    for i in range(round(duration / step)):
        walk.advance((i + 1) * step, step, (x, y))
        px, py, _ = walk.pose
        away = float(np.hypot(px - x, py - y))
        least = min(least, away)
        if not laws.is_evading(side != 0, away, safety_radius, inf):
            continue
        seen = wrap_angle(atan2(py - y, px - x) - theta)
        side = side or laws.side_behind(seen)
        aim = laws.evasion_heading(seen, side, angle)
        theta += laws.proportional_rate(aim, gain) * step
        x -= step * speed * cos(theta)
        y -= step * speed * sin(theta)
        theta = wrap_angle(theta) if abs(theta) > pi else theta
    return least
