"""Settings of gait, control and body from a robot description."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..core.entries import read_entries
from ..locomotion.control_settings import ControlSettings, LegsSettings
from ..planning import GaitSettings
from ..robots.description import FILE, RobotDescription, load_robot
from ..sim.body_settings import BODIES, BodySettings
from ..strategies import Evasion
from .player_settings import RobotSettings

# Template of learned legs: speed [m/s], gain [1/s], and 0.4 s from decision to
# decision, in path time as in gait time. Their CoM is over the feet.
LEGS_GAIT: Mapping[str, Any] = {
    "speed": 0.5,
    "gain": 0.4,
    "stride": 0.2,
    "single_support": 0.3,
    "double_support": 0.1,
    "zmp_forward": 0.0,
}


def settings_from_description(description: RobotDescription) -> RobotSettings:
    """Return robot, gait, control, legs and safety radius of a description."""
    source = str(description.folder / FILE)
    gait: dict[str, Any] = dict(description.gait)
    network = description.locomotion.get("network", "")
    if network:
        network = str(description.path_of(network))
        gait |= LEGS_GAIT
    if description.sole:
        gait["sole"] = dict(description.sole)
    return RobotSettings(
        robot=str(description.folder),
        gait=read_entries(GaitSettings, gait, f"{source}, gait"),
        control=read_entries(
            ControlSettings, dict(description.control), f"{source}, control"
        ),
        legs=LegsSettings(network),
        evasion=Evasion(safety_radius=description.game.safety_radius),
    )


def body_of_robot(robot: str | Path, name: str) -> BodySettings:
    """Return the body of a preset, with the errors of a robot.

    The ideal body is that of all robots; in others the ``[body]`` of the
    robot's description replaces values of NAO.
    """
    preset = BODIES[name]
    description = load_robot(robot)
    if name == "ideal" or not description.body:
        return preset
    source = f"{description.folder / FILE}, body"
    return read_entries(
        BodySettings, dict(description.body), source, base=preset
    )
