"""Walks of a person: steering, straight or recorded."""

from math import atan2, copysign, cos, hypot, inf, pi, sin
from pathlib import Path

import numpy as np

from ..arena import NO_OBSTACLES, ObstacleSet
from ..core.errors import ConfigurationError
from ..core.poses import Array, Pose, wrap_angle
from ..theory import laws
from .crowd_motion import CrowdMotion, Neighbour
from .person_settings import PATHS, RADIUS, CrowdSettings, PersonSettings

Place = tuple[float, float]
BEYOND = 8.0  # goal of a person who reacts, beyond the evader, in [m]


class PersonMotion:
    """Walk of a person, integrated step by step.

    A person slides along obstacles. A recorded path ignores them, and the
    initial pose.
    """

    def __init__(
        self,
        settings: PersonSettings,
        start: Pose,
        evader: Place,
        obstacles: ObstacleSet = NO_OBSTACLES,
    ) -> None:
        self._settings, self._obstacles = settings, obstacles
        self._recorded: Array | None = None
        heading = start.theta
        if settings.path == "straight":
            sight = atan2(evader[1] - start.y, evader[0] - start.x)
            aim = (
                evader[0] - settings.miss * sin(sight),
                evader[1] + settings.miss * cos(sight),
            )
            heading = atan2(aim[1] - start.y, aim[0] - start.x)
        self._course = heading
        self._walked, self._has_turned = 0.0, False
        self._was_near, self._feints_until = False, -inf
        self._reacting: CrowdMotion | None = None
        if settings.reaction != "none":
            far = hypot(aim[0] - start.x, aim[1] - start.y) + BEYOND
            self._reacting = CrowdMotion(
                CrowdSettings(settings.speed, settings.reaction),
                Pose(start.x, start.y, heading),
                (start.x + far * cos(heading), start.y + far * sin(heading)),
                obstacles,
            )
        self.pose = self._pose_facing(start.x, start.y)
        if settings.path not in PATHS:
            self._recorded = read_path(Path(settings.path))
            self.pose = self._recorded_pose(0.0)

    def advance(self, time: float, duration: float, evader: Place) -> None:
        """Advance the walk by one step, which ends at a time."""
        if self._recorded is not None:
            self.pose = self._recorded_pose(time)
            return
        if self._reacting is not None:
            robot = Neighbour(*evader, is_person=False)
            self._reacting.advance(time, duration, [robot])
            self.pose = self._reacting.pose
            return
        x, y, _ = self.pose
        settings = self._settings
        step_length = settings.speed * duration
        if self._walked + 0.5 * step_length > settings.halt_after:
            return
        if (
            not self._has_turned
            and self._walked + 0.5 * step_length > settings.turn_after
        ):
            self._has_turned = True
            self._course += settings.turn
        if settings.path == "steer":
            # (1)-(2) of the paper, held over one tick.
            aim = laws.pursuit_heading(self._bearing(time, evader))
            turn = laws.proportional_rate(aim, settings.gain) * duration
            if settings.turning_radius > 0.0:
                most = step_length / settings.turning_radius
                turn = min(max(turn, -most), most)
            self._course += turn
        self._walked += step_length
        course = self._course
        step = step_length * cos(course), step_length * sin(course)
        dx, dy = self._along_walls((x, y), step)
        self.pose = self._pose_facing(x + dx, y + dy)

    def _bearing(self, time: float, evader: Place) -> float:
        """Return the bearing of the evader, or during a feint another."""
        x, y, _ = self.pose
        dx, dy = evader[0] - x, evader[1] - y
        settings = self._settings
        is_near = hypot(dx, dy) < settings.feint_at
        if is_near and not self._was_near:
            self._feints_until = time + abs(settings.feint)
        self._was_near = is_near
        if time < self._feints_until:
            return copysign(0.5 * pi, settings.feint)
        return wrap_angle(atan2(dy, dx) - self._course)

    def _along_walls(self, place: Place, step: Place) -> Place:
        """Return a step without its components into near obstacles, [m]."""
        if not self._obstacles:
            return step
        near = self._obstacles.clearances([place])[0] < RADIUS
        outward = self._obstacles.directions_out([place])[0]
        dx, dy = step
        for u, v in outward[near].tolist():
            inward = min(0.0, dx * u + dy * v)
            dx, dy = dx - inward * u, dy - inward * v
        return dx, dy

    def _pose_facing(self, x: float, y: float) -> Pose:
        """Return the pose at a position, facing along the walk or backward."""
        if self._settings.backward:
            return Pose(x, y, wrap_angle(self._course + pi))
        return Pose(x, y, self._course)

    def _recorded_pose(self, time: float) -> Pose:
        assert self._recorded is not None
        times, x, y = self._recorded.T
        later = min(time, float(times[-1]) - 0.1) + 0.1
        u = np.interp([time, later - 0.1, later], times, x)
        v = np.interp([time, later - 0.1, later], times, y)
        position = float(u[0]), float(v[0])
        dx, dy = float(u[2] - u[1]), float(v[2] - v[1])
        heading = atan2(dy, dx) if (dx, dy) != (0.0, 0.0) else 0.0
        return Pose(*position, heading)


def read_path(file: Path) -> Array:
    """Return a recorded path: rows of time [s], x [m] and y [m]."""
    try:
        head, *lines = file.read_text(encoding="utf-8").splitlines() or [""]
        if "".join(head.split()) != "time,x,y":
            raise ValueError("the first line must be time,x,y")
        rows = [[float(cell) for cell in line.split(",")] for line in lines]
        if len(rows) < 2 or {len(row) for row in rows} != {3}:
            raise ValueError(f"it needs two rows of time,x,y, has {len(rows)}")
        table = np.array(rows)
        if not np.isfinite(table).all() or np.diff(table[:, 0]).min() <= 0.0:
            raise ValueError(
                "times and positions must be finite, and times must increase"
            )
    except (OSError, ValueError) as error:
        raise ConfigurationError(
            f"person.path must be {', '.join(PATHS)} or a CSV file of "
            f"time,x,y [s, m, m], got {str(file)!r}: {error}"
        ) from error
    return table
