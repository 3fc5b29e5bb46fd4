"""Motion of a player of a recorded run."""

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Pose
from .run_archive import load_run


class RecordedMotion:
    """Motion of a player of a recorded run, in the world of that run.

    It rests at the end of the recording.
    """

    def __init__(self, folder: str, player: str) -> None:
        """Read a run folder.

        Args:
            folder: The run folder.
            player: Name of the player; empty if there is only one.

        Raises:
            ConfigurationError: If there is no such run or player.
        """
        run = load_run(folder)
        name = player
        if not player and len(run.players) == 1:
            (name,) = run.players
        if name not in run.tracks:
            raise ConfigurationError(
                f"run_player must be one of {', '.join(run.players)}, got "
                f"{name!r}"
            )
        self._times = run.times
        self._poses = run.tracks[name].unicycle

    def pose_at(self, time: float) -> Pose:
        """Return the pose at a time, in [s]."""
        x, y, theta = (
            float(np.interp(time, self._times, column))
            for column in self._poses.T
        )
        return Pose(x, y, theta)
