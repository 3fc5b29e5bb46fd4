"""Bodies of robots: presets, with the errors that a robot describes."""

from pathlib import Path

from ..core.entries import read_entries
from ..robots.description import FILE, load_robot
from ..sim.body_settings import BODIES, BodySettings


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
