"""Bodies of a run, put where they were."""

import mujoco
import numpy as np

from ..errors import ConfigurationError
from ..games.duel import furnisher_of, walkers_of
from ..games.run import Run
from ..games.settings import PURSUER
from ..poses import Pose
from ..robots.description import load_robot
from ..world.person import parts_of, pose_figure
from ..world.world import build_model


class Stage:
    """Bodies of a run, put where they were.

    Attributes:
        model: Robots and floor.
        data: Their state.
    """

    def __init__(self, run: Run) -> None:
        """Build the robots of a run, without its physics.

        Raises:
            ConfigurationError: If it is a run of other robots.
        """
        description = load_robot(run.settings.robot)
        walkers = walkers_of(run.settings)
        self.model = build_model(
            dict.fromkeys(walkers, description),
            run.settings.physics,
            seed=run.settings.seed,
            furnish=furnisher_of(run.settings),
        )
        self.data = mujoco.MjData(self.model)
        postures = [run.tracks[name].qpos for name in walkers]
        known = [qpos for qpos in postures if qpos is not None]
        wide = sum(qpos.shape[1] for qpos in known)
        if len(known) < len(walkers) or wide != self.model.nq:
            raise ConfigurationError(
                f"qpos of run {run.name} must have {self.model.nq} columns "
                f"for {', '.join(walkers)}, as {run.settings.robot!r} has, "
                f"got {wide}"
            )
        self._postures = np.concatenate(known, axis=1).astype(np.float64)
        self._person: dict[str, int] | None = None
        if PURSUER not in walkers:
            self._person = parts_of(self.model, PURSUER)
        self._walked = run.pursuer.torso

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
