"""Joining a ROS 2 domain, by the options of a command."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from .terminal import echo

if TYPE_CHECKING:
    from ..drivers.ros2.dds_domain import DdsParticipant


def join_domain(options: Mapping[str, Any]) -> "DdsParticipant":
    """Join, and say on stderr what ROS 2 needs to be met there.

    Args:
        options: Of the command: ``domain`` and ``network``.
    """
    from ..drivers.ros2.dds_domain import LOCAL, DdsParticipant

    dds = DdsParticipant(options["domain"], beyond=options["network"])
    if not options["network"]:
        echo(f"stepaside: {LOCAL}", err=True)
    return dds
