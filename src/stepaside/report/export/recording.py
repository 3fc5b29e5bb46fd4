"""Recording of a run for other programs, in no particular format."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np

from ...core.errors import ConfigurationError
from ...core.player_colours import Colour
from ...core.poses import Array
from ...games.game import Progress
from ...games.game_furnishing import colours_of_players
from ...games.play_rows import read_played
from ...games.replayed_signals import RobotSignals, repeat_game
from ...games.run import Run
from ...games.run_archive import load_run
from ...robots.description import RobotDescription, load_robot
from ...robots.urdf_writer import UrdfTree, urdf_of, urdf_tree
from ...sim.ground_truth import centers_of_pressure

BEYOND = (
    "joint velocities and efforts, IMU, foot forces, DCM, planned footsteps, "
    "strategy, images"
)


@dataclass(frozen=True, slots=True, eq=False)
class RobotModel:
    """Model of a robot in a recording.

    Attributes:
        description: Description of the robot.
        model: Its compiled model, in the colour of the player.
        urdf: Its URDF, as XML text.
        tree: Its links and joints.
        joints: Names of its joints, in the order of qpos.
        foot_sites: Positions of the foot force sensors in the frames of
            their soles, in [m], in the order of
            ``RobotState.foot_forces``. Shape (8, 3).
    """

    description: RobotDescription
    model: mujoco.MjModel
    urdf: str
    tree: UrdfTree
    joints: tuple[str, ...]
    foot_sites: Array

    @classmethod
    def of(cls, robot: str, colour: Colour | None) -> "RobotModel":
        """Build the model of a robot by name or folder, in a colour."""
        description = load_robot(robot)
        model = description.compile(colour)
        names = [
            model.joint(i).name
            for i in range(model.njnt)
            if model.jnt_type[i] != mujoco.mjtJoint.mjJNT_FREE
        ]
        return cls(
            description,
            model,
            urdf_of(description, colour),
            urdf_tree(description, model),
            tuple(names),
            _foot_sites(description, model),
        )


class FootWrench(NamedTuple):
    """Wrench of the floor on a sole, from its normal forces.

    Attributes:
        frame: Name of the frame of the sole.
        force: Upward force, in [N]. Shape (n,).
        torque: Torque (x, y) about the origin of the sole, in [N m]. Shape
            (n, 2).
    """

    frame: str
    force: Array
    torque: Array


@dataclass(frozen=True, slots=True, eq=False)
class Recording:
    """Run with all signals that its folder or a repetition provides.

    Attributes:
        run: The run.
        models: Models of the robots whose joints were recorded, by player.
        signals: Signals of robots beyond their trajectories, by player.
        absent: Missing signals and the reasons, as sentences.
    """

    run: Run
    models: Mapping[str, RobotModel]
    signals: Mapping[str, RobotSignals]
    absent: tuple[str, ...]

    def write_urdf(self, folder: Path) -> None:
        """Write the URDF of each robot into a folder."""
        for name, model in self.models.items():
            (folder / f"{name}.urdf").write_text(model.urdf, encoding="utf-8")


def load_recording(
    folder: Path, *, repeats: bool, report: Callable[[Progress], None]
) -> Recording:
    """Read a run folder, and play its game again for what it lacks.

    Args:
        folder: The run folder.
        repeats: Whether to play the game again.
        report: Called about five times a second with the progress.

    Raises:
        ConfigurationError: If the folder is not a valid run folder.
    """
    run = load_run(folder)
    colours = colours_of_players(run.settings)
    models = {
        name: RobotModel.of(
            run.settings.robot_of(name).robot, colours.get(name)
        )
        for name, track in run.tracks.items()
        if track.qpos is not None
    }
    absent = [
        f"{name}: no joints, as it is no robot"
        if name not in run.robots
        else f"{name}: no joints, as none were recorded"
        for name in run.players
        if name not in models
    ]
    signals: Mapping[str, RobotSignals] = {}
    if run.game == "play":
        signals = _signals_of_play(folder, run, models)
        absent.append("joint velocities and efforts: a play does not record")
    elif not repeats:
        absent.append(f"{BEYOND}: the game was not played again (--repeat)")
    elif models:
        repeated = repeat_game(run, report)
        signals = repeated.robots
        if repeated.reason:
            absent.append(f"{BEYOND}: {repeated.reason}")
    return Recording(run, models, signals, tuple(absent))


def _signals_of_play(
    folder: Path, run: Run, models: Mapping[str, RobotModel]
) -> dict[str, RobotSignals]:
    """Return the measurements of a play, at the samples of its run.

    Raises:
        ConfigurationError: If the rows cannot be read.
    """
    try:
        rows = read_played(folder)
    except (OSError, ValueError) as error:
        raise ConfigurationError(
            f"rows of run {folder} could not be read: {error}"
        ) from error
    if not rows.moves_joints:
        return {}
    sampled = rows.sampled
    signals = RobotSignals(
        gyro=rows.columns["gyro"][sampled],
        accelerometer=rows.columns["accelerometer"][sampled],
        foot_forces=rows.columns["foot_forces"][sampled],
    )
    return dict.fromkeys(models, signals)


def foot_wrenches(model: RobotModel, forces: Array) -> tuple[FootWrench, ...]:
    """Return the wrench of the floor on each sole.

    Args:
        model: The robot.
        forces: Normal forces at the corners of the soles, in [N]. Shape (n,
            8).
    """
    wrenches = []
    for side, frame in enumerate(("l_sole", "r_sole")):
        own = forces[:, 4 * side : 4 * side + 4]
        corners = model.foot_sites[4 * side : 4 * side + 4]
        total = own.sum(axis=1)
        points = np.broadcast_to(corners, (len(own), 4, 3))
        center = np.nan_to_num(centers_of_pressure(own, points))
        torque = np.column_stack([center[:, 1] * total, -center[:, 0] * total])
        wrenches.append(FootWrench(frame, total, torque))
    return tuple(wrenches)


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
