"""How ``stepaside play`` moves a robot on NAOqi."""

from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..drivers.naoqi.velocity_mover import Mover
    from ..games.duel_settings import DuelSettings

LOLA, NAOQI = "lola:", "naoqi:"


def check_way(options: dict[str, Any]) -> None:
    """Refuse a choice that a robot does not have.

    Args:
        options: Of the command.
    """
    if options["by"] is not None and not options["robot"].startswith(NAOQI):
        raise click.UsageError(
            f"--by is for robots on {NAOQI}: one on LoLA is moved by its "
            "joints, one on ROS 2 topics by velocity"
        )


def by_joints(options: dict[str, Any]) -> bool:
    """Whether a robot is moved by its joints.

    Args:
        options: Of the command.
    """
    joints: bool = options["by"] == "joints"
    return joints or options["robot"].startswith(LOLA)


def mover_of(
    settings: "DuelSettings", options: dict[str, Any]
) -> "Callable[[Any, Callable[[], float]], Mover]":
    """What takes velocities to the ALMotion of a robot, as it was chosen."""
    from ..drivers.naoqi.velocity_mover import VelocityMover

    if options["by"] != "footsteps":
        return VelocityMover
    from ..drivers.naoqi.footstep_mover import FootstepMover

    return lambda motion, clock: FootstepMover(motion, settings.gait, clock)
