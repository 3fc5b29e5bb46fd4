"""ROS 2 domain of a command, with a hint for local discovery."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from .terminal import echo

if TYPE_CHECKING:
    from ..drivers.ros2.dds_domain import DdsParticipant


def join_domain(options: Mapping[str, Any]) -> "DdsParticipant":
    """Join a ROS 2 domain; print what other programs need to discover it.

    Args:
        options: Options of the command: ``domain`` and ``network``.
    """
    from ..drivers.ros2.dds_domain import LOCAL, DdsParticipant

    dds = DdsParticipant(options["domain"], beyond=options["network"])
    if not options["network"]:
        echo(f"stepaside: {LOCAL}", err=True)
    return dds
