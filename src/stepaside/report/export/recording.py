"""Recording of a run for other programs, in no particular format."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import mujoco
import numpy as np

from ...core.player_identity import Colour
from ...core.poses import Array
from ...games.game import Progress, play
from ...games.game_furnishing import colours_of_players
from ...games.game_settings import GameSettings
from ...games.recorded_game import RecordedGame
from ...games.run import Run
from ...robots.description import RobotDescription, load_robot
from ...robots.urdf_writer import urdf_of

BEYOND = (
    "joint velocities and efforts, IMU, foot forces, DCM, planned footsteps, "
    "strategy, images"
)


@dataclass(frozen=True, slots=True, eq=False)
class RobotModel:
    """Model of a robot in a recording, in the colour of its player."""

    urdf: str  # XML text
    joints: tuple[str, ...]  # their names, in the order of qpos
    foot_sites: Array  # force sensors in their soles' frames, [m], (8, 3)

    @classmethod
    def of(cls, robot: str, colour: Colour | None) -> "RobotModel":
        """Build the model of a robot by name or folder."""
        description = load_robot(robot)
        model = description.compile(colour)
        joints = [
            model.joint(i).name
            for i in range(model.njnt)
            if model.jnt_type[i] != mujoco.mjtJoint.mjJNT_FREE
        ]
        return cls(
            urdf_of(description, colour),
            tuple(joints),
            _foot_sites(description, model),
        )


@dataclass(frozen=True, slots=True, eq=False)
class Recording:
    """Run with all signals that its folder or a repetition provides."""

    run: Run
    models: Mapping[str, RobotModel]  # of robots with joints, by player
    absent: tuple[str, ...]  # missing signals and reasons, as sentences

    def write_urdf(self, folder: Path) -> None:
        """Write the URDF of each robot into a folder."""
        for name, model in self.models.items():
            (folder / f"{name}.urdf").write_text(model.urdf, encoding="utf-8")


def recording_of(
    run: Run, *, repeats: bool, report: Callable[[Progress], None]
) -> Recording:
    """Record a run; if it ``repeats``, play its game for what it lacks."""
    colours = colours_of_players(run.settings)
    models = {
        name: RobotModel.of(run.settings.player(name).robot, colours.get(name))
        for name in run.robots
    }
    absent = [
        f"{name}: no joints, as it is no robot"
        for name in run.players
        if name not in models
    ]
    if run.game == "play":
        absent.append("joint velocities and efforts: a play does not record")
    elif not repeats:
        absent.append(f"{BEYOND}: the game was not played again (--repeat)")
    elif models:
        run, reason = repeat_game(run, report)
        absent += [f"{BEYOND}: {reason}"] if reason else []
    return Recording(run, models, tuple(absent))


def repeat_game(
    run: Run, report: Callable[[Progress], None] | None = None
) -> tuple[Run, str]:
    """Play a game again for the signals that its run folder lacks.

    Returns:
        The run with all signals; or as it is, and the reason, if the game
        differed from its run or cannot be repeated.

    Raises:
        StepAsideError: If the settings cannot be met on this computer, for
            example for want of a renderer.
        KeyboardInterrupt: If it was interrupted.
    """
    if not isinstance(run.settings, GameSettings) or not run.robots:
        return run, f"a {run.game} cannot be repeated"
    game = RecordedGame(run.settings, closely=True)
    game.rules = replace(game.rules, duration=run.duration)
    play(game, report=report)
    again = game.run().uninterrupted()
    for name in run.robots:
        then, now = run.tracks[name].qpos, again.tracks[name].qpos
        if then is None or now is None:
            return run, f"{name} has no recorded joint angles"
        if not np.array_equal(again.times, run.times) or not np.array_equal(
            then, now
        ):
            return run, (
                f"played again, {name} moved differently: its commands came "
                "from elsewhere, or this computer calculates differently"
            )
    return replace(run, tracks=again.tracks), ""


def _foot_sites(description: RobotDescription, model: mujoco.MjModel) -> Array:
    """Return the foot force sensors in the frames of their soles, (8, 3)."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    rows = []
    for number, name in enumerate(description.sensors.feet):
        foot = description.left_foot if number < 4 else description.right_foot
        sole = data.site(foot)
        axes = sole.xmat.reshape(3, 3)
        rows.append(axes.T @ (data.site(name).xpos - sole.xpos))
    return np.array(rows)
