"""A run folder, ready to be seen again."""

import json
from dataclasses import dataclass
from math import degrees
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from ..errors import ConfigurationError
from ..games.configuration import load_configuration
from ..games.duel import NAMES
from ..games.people import furnisher_of, walkers_of
from ..games.settings import DuelSettings
from ..games.summary import (
    distance_over_time,
    orientation_over_time,
    theory_of,
)
from ..poses import Array, Pose
from ..robots.description import load_robot
from ..world.person import parts_of, pose_figure
from ..world.world import build_model
from .run_folder import CONFIGURATION, SUMMARY, TRAJECTORIES


@dataclass(frozen=True, slots=True)
class Run:
    """A duel that was played.

    Attributes:
        name: Name of its folder.
        settings: What decided it.
        summary: Its figures.
        arrays: Its record.
    """

    name: str
    settings: DuelSettings
    summary: dict[str, Any]
    arrays: dict[str, Array]

    @property
    def times(self) -> Array:
        """Times of the samples, in [s]. Shape (n,)."""
        return self.arrays["times_s"]

    @property
    def distance(self) -> Array:
        """Distance between the torsos, in [m]. Shape (n,)."""
        return distance_over_time(self.arrays)

    @property
    def orientation(self) -> Array:
        """Angle between the headings, in [deg]. Shape (n,)."""
        angle: Array = np.degrees(orientation_over_time(self.arrays))
        return angle

    @property
    def theory(self) -> tuple[float, float, float] | None:
        """Radius [m], distance [m] and angle [deg] of the circle."""
        circle = theory_of(self.settings)
        if not circle.exists:
            return None
        return (
            circle.radius_evader_m,
            circle.distance_m,
            degrees(circle.headings_apart_rad),
        )

    @property
    def circle(self) -> tuple[float, float, float] | None:
        """Theory's circle, round where the robots went in the end.

        Returns:
            Center (x, y) in the world and radius, in [m]; None if they were
            never on it.
        """
        since = self.summary.get("converged_at_s")
        if self.theory is None or since is None:
            return None
        tail = self.times >= since
        middles = [self.arrays[f"{n}_torso"][tail, :2].mean(0) for n in NAMES]
        x, y = np.mean(middles, axis=0).tolist()
        return x, y, self.theory[0]

    def words(self, index: int) -> str:
        """What goes on at a sample."""
        time = float(self.times[index])
        triggered = self.summary.get("triggered_at_s")
        converged = self.summary.get("converged_at_s")
        last = index >= len(self.times) - 1
        if last and self.summary["outcome"] in ("fall", "contact"):
            return str(self.summary["message"])
        if triggered is None or time < triggered:
            return "the pursuer comes; the evader stands"
        if time < triggered + 1.0:
            return "the evader is triggered"
        if converged is not None and time >= converged:
            return "both robots are on the circle"
        return "the evader is evading"


def load_run(folder: Path) -> Run:
    """Read a run folder.

    Raises:
        ConfigurationError: If it is none.
    """
    for name in (CONFIGURATION, SUMMARY, TRAJECTORIES):
        if not (folder / name).is_file():
            raise ConfigurationError(
                f"run must be a folder with {CONFIGURATION}, {SUMMARY} and "
                f"{TRAJECTORIES}; {folder} has no {name}"
            )
    try:
        summary = json.loads((folder / SUMMARY).read_text(encoding="utf-8"))
        with np.load(folder / TRAJECTORIES) as stored:
            arrays = {name: stored[name] for name in stored.files}
    except (ValueError, OSError) as error:
        raise ConfigurationError(
            f"run {folder} cannot be read: {error}"
        ) from error
    settings = load_configuration(folder / CONFIGURATION)
    return Run(folder.resolve().name, settings, summary, arrays)


class Stage:
    """Bodies of a run, put where they were.

    Attributes:
        model: Robots and floor.
        data: Their state.
    """

    def __init__(self, run: Run) -> None:
        """Build the robots of a run, without its physics."""
        description = load_robot(run.settings.robot)
        walkers = walkers_of(run.settings)
        self.model = build_model(
            dict.fromkeys(walkers, description),
            run.settings.physics,
            seed=run.settings.seed,
            furnish=furnisher_of(run.settings, None),
        )
        self.data = mujoco.MjData(self.model)
        self._postures = np.concatenate(
            [run.arrays[f"{name}_qpos"] for name in walkers], axis=1
        ).astype(np.float64)
        self._person: dict[str, int] | None = None
        if len(walkers) < len(NAMES):
            self._person = parts_of(self.model, NAMES[0])
            self._walked: Array = run.arrays[f"{NAMES[0]}_torso"]

    def put(self, index: int) -> None:
        """Put the bodies where they were at a sample."""
        self.data.qpos[:] = self._postures[index]
        if self._person is not None:
            frame = Pose(*self._walked[index].tolist())
            steps = np.diff(self._walked[: index + 1, :2], axis=0)
            way = float(np.hypot(steps[:, 0], steps[:, 1]).sum())
            pose_figure(self.data, self._person, frame, way)
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)
