"""Choice of the motion interface of a robot over NAOqi."""

from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..drivers.naoqi.velocity_mover import Mover
    from ..games.duel_settings import DuelSettings

LOLA, NAOQI = "lola:", "naoqi:"


def check_mover(options: dict[str, Any]) -> None:
    """Refuse ``--by`` for a robot that is not on NAOqi.

    Args:
        options: Options of the command.
    """
    if options["by"] is not None and not options["robot"].startswith(NAOQI):
        raise click.UsageError(
            f"--by requires a robot at {NAOQI}, got {options['robot']!r}; "
            "LoLA accepts joint targets only, ROS 2 velocities only"
        )


def moves_joints(options: dict[str, Any]) -> bool:
    """Return whether the robot receives joint targets.

    Args:
        options: Options of the command.
    """
    joints: bool = options["by"] == "joints"
    return joints or options["robot"].startswith(LOLA)


def mover_factory(
    settings: "DuelSettings", options: dict[str, Any]
) -> "Callable[[Any, Callable[[], float]], Mover]":
    """Return the factory of the mover that sends commands to ALMotion."""
    from ..drivers.naoqi.velocity_mover import VelocityMover

    if options["by"] != "footsteps":
        return VelocityMover
    from ..drivers.naoqi.footstep_mover import FootstepMover

    return lambda motion, clock: FootstepMover(motion, settings.gait, clock)
