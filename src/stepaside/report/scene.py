"""MuJoCo scene of a recorded run, posed sample by sample."""

from functools import partial

import mujoco
import numpy as np

from ..arena import OPEN_FLOOR, Room
from ..core.errors import ConfigurationError
from ..core.poses import Array, Pose
from ..games.game_furnishing import colours_of_players, furnish_game
from ..games.game_settings import GameSettings
from ..games.run import Run
from ..robots.description import load_robot
from ..sim.camera_scene import hide_walls
from ..sim.person_body import (
    add_template,
    mocap_indices,
    pose_template,
    set_person_pose,
)
from ..sim.physics_settings import PhysicsSettings
from ..sim.room_furnishing import obstacle_mover
from ..sim.world import build_model


class RunScene:
    """Players, floor and obstacles of a run as a kinematic MuJoCo model.

    Attributes:
        model: Robots, persons, floor and obstacles.
        data: Their poses at the sample that was shown last.
    """

    def __init__(self, run: Run) -> None:
        """Build the model of a run, without its dynamics.

        Raises:
            ConfigurationError: If the recorded joint angles do not fit the
                robots.
        """
        self._times, self._tracks = run.times, run.tracks
        persons = run.persons
        self._templates = [
            name for name in run.players if name not in run.robots + persons
        ]
        names = {name: run.settings.player(name).robot for name in run.robots}
        physics, seed = PhysicsSettings(), 0
        if run.game not in ("play", "experiment"):
            physics, seed = run.settings.physics, run.settings.seed
        furnish = self._add_templates
        if isinstance(run.settings, GameSettings):
            furnish = partial(
                furnish_game,
                settings=run.settings,
                templates=self._templates,
            )
        self.model = build_model(
            {name: load_robot(robot) for name, robot in names.items()},
            physics,
            seed=seed,
            furnish=furnish,
            colours=colours_of_players(run.settings),
        )
        hide_walls(self.model)
        self.data = mujoco.MjData(self.model)
        room = run.plan or OPEN_FLOOR
        self._move_obstacles = obstacle_mover(self.model, self.data, room)
        self._persons = {
            name: mocap_indices(self.model, name) for name in persons
        }
        self._walked = {
            name: _distance_walked(run.tracks[name].torso[:, :2])
            for name in persons
        }
        self._qpos = self._joint_angles_of(run, names)

    def _add_templates(self, spec: mujoco.MjSpec) -> None:
        for name in self._templates:
            add_template(spec, name)

    def _joint_angles_of(self, run: Run, names: dict[str, str]) -> Array:
        """Return qpos of all robots at all samples. Shape (n, nq)."""
        recorded = [run.tracks[name].qpos for name in names]
        known = [qpos for qpos in recorded if qpos is not None]
        columns = sum(qpos.shape[1] for qpos in known)
        if len(known) < len(names) or columns != self.model.nq:
            raise ConfigurationError(
                f"qpos of run {run.name} must have {self.model.nq} columns "
                f"for {', '.join(names)}, as "
                f"{' and '.join(dict.fromkeys(names.values()))} have, "
                f"got {columns}"
            )
        empty = np.zeros((len(run.times), 0))
        return np.concatenate([empty, *known], axis=1)

    def put(self, index: int) -> None:
        """Pose all bodies as at a sample of the run."""
        self.data.qpos[:] = self._qpos[index]
        self._move_obstacles(float(self._times[index]))
        for name, parts in self._persons.items():
            pose = Pose(*self._tracks[name].torso[index].tolist())
            walked = float(self._walked[name][index])
            set_person_pose(self.data, parts, pose, walked)
        for name in self._templates:
            pose = Pose(*self._tracks[name].torso[index].tolist())
            pose_template(self.model, self.data, name, pose)
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)


def wall_corners(room: Room | None) -> Array:
    """Return the corners of all walls of a room, in [m]. Shape (n, 2)."""
    walls = () if room is None else room.walls
    return np.concatenate([np.zeros((0, 2)), *(w.points for w in walls)])


def _distance_walked(positions: Array) -> Array:
    """Return the length of a path (n, 2) up to each sample, in [m]."""
    steps = np.diff(positions, axis=0)
    lengths = np.hypot(steps[:, 0], steps[:, 1])
    return np.concatenate([[0.0], np.cumsum(lengths)])
