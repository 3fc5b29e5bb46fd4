"""MuJoCo scene of a recorded run, posed sample by sample."""

import mujoco
import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array, Pose
from ..games.duel_settings import EVADER, DuelSettings
from ..games.initial_poses import initial_poses, wall_distance
from ..games.run import Run
from ..robots.description import load_robot
from ..robots.head import load_head
from ..sim.obstacle_geoms import add_solids, obstacle_mover
from ..sim.passer_bodies import add_passers, passer_mover
from ..sim.passerby_settings import Passer
from ..sim.pedestrian_models import FIGURES
from ..sim.person_body import add_person, mocap_indices, set_person_pose
from ..sim.room_furnishing import Furnish, furnisher, hide_walls
from ..sim.template_body import add_template, pose_template
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
        robots = run.robots
        names = {name: run.settings.robot_of(name).robot for name in robots}
        persons = run.persons
        self._templates = [
            name for name in run.players if name not in {*robots, *persons}
        ]

        settings = run.settings
        figure = "adult"
        passers: tuple[Passer, ...] = ()
        if isinstance(settings, DuelSettings):
            figure = settings.person.figure
            passers = settings.passers
        self._figure = FIGURES[figure]
        room = run.plan
        furnish_surroundings = surroundings_of(run)

        def furnish(spec: mujoco.MjSpec) -> None:
            if furnish_surroundings is not None:
                furnish_surroundings(spec)
            if room is not None:
                add_solids(spec, room)
            for name in persons:
                add_person(spec, name, self._figure)
            add_passers(spec, passers)
            for name in self._templates:
                add_template(spec, name)

        self.model = build_model(
            {name: load_robot(robot) for name, robot in names.items()},
            run.settings.physics,
            seed=run.settings.seed,
            furnish=furnish,
        )
        hide_walls(self.model)
        self.data = mujoco.MjData(self.model)
        recorded = [run.tracks[name].qpos for name in robots]
        known = [qpos for qpos in recorded if qpos is not None]
        columns = sum(qpos.shape[1] for qpos in known)
        if len(known) < len(robots) or columns != self.model.nq:
            raise ConfigurationError(
                f"qpos of run {run.name} must have {self.model.nq} columns "
                f"for {', '.join(robots)}, as "
                f"{' and '.join(dict.fromkeys(names.values()))} have, "
                f"got {columns}"
            )
        empty = np.zeros((len(run.times), 0))
        self._qpos = np.concatenate([empty, *known], axis=1)
        self._persons = {
            name: mocap_indices(self.model, name) for name in persons
        }
        self._walked = {
            name: _distance_walked(run.tracks[name].torso[:, :2])
            for name in persons
        }
        self._tracks = run.tracks
        self._times = run.times
        self._movers = []
        if room is not None:
            self._movers.append(obstacle_mover(self.model, self.data, room))
        if isinstance(settings, DuelSettings) and passers:
            evader = initial_poses(settings)[1]
            self._movers.append(
                passer_mover(self.model, self.data, passers, evader)
            )

    def put(self, index: int) -> None:
        """Pose all bodies as at a sample of the run."""
        self.data.qpos[:] = self._qpos[index]
        for move in self._movers:
            move(float(self._times[index]))
        for name, parts in self._persons.items():
            pose = Pose(*self._tracks[name].torso[index].tolist())
            walked = float(self._walked[name][index])
            set_person_pose(self.data, parts, pose, walked, self._figure)
        for name in self._templates:
            pose = Pose(*self._tracks[name].torso[index].tolist())
            pose_template(self.model, self.data, name, pose)
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)


def _distance_walked(positions: Array) -> Array:
    """Return the length of the path up to each sample, in [m]. Shape (n,).

    Args:
        positions: In the world, in [m]. Shape (n, 2).
    """
    steps = np.diff(positions, axis=0)
    lengths = np.hypot(steps[:, 0], steps[:, 1])
    return np.concatenate([[0.0], np.cumsum(lengths)])


def surroundings_of(run: Run) -> Furnish | None:
    """Return what adds walls, objects and depth camera of a run with cameras.

    Args:
        run: The run.

    Returns:
        Function that furnishes a model; None for runs without cameras.
    """
    settings = run.settings
    if not isinstance(settings, DuelSettings):
        return None
    if settings.sensing != "cameras" or EVADER not in run.robots:
        return None
    head = load_head(load_robot(settings.robot_of(EVADER).robot))
    return furnisher(
        settings.room, EVADER, head, walls=wall_distance(settings)
    )
