"""Addresses at which ``stepaside serve`` serves simulated robots."""

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from ..games.robot_endpoints import RobotEndpoint

ADDRESS_FORMATS = {
    "lola": "PATH",
    "ros2": "/NAMESPACE",
}


def endpoints_of(
    options: Mapping[str, Any], stack: ExitStack, *, ideal_sight: bool
) -> "dict[str, RobotEndpoint]":
    """Return the endpoint of each served player.

    Args:
        options: Options of the command: players and addresses by interface,
            ``domain`` and ``network``.
        stack: Closes the ROS 2 participant at the end.
        ideal_sight: Whether the true line of sight is served.
    """
    from ..games.robot_endpoints import LolaEndpoint

    endpoints: dict[str, RobotEndpoint] = {}
    for name, place in _entries("lola", options["lola"], endpoints):
        endpoints[name] = LolaEndpoint(place, ideal_sight)
    if options["ros2"]:
        from ..drivers.ros2_dds import parse_namespace
        from ..drivers.ros2_server import WorldClock
        from ..games.robot_endpoints import Ros2Endpoint
        from .connection_settings import join_domain

        dds = join_domain(options["domain"], network=options["network"])
        stack.callback(dds.close)
        clock = WorldClock(dds)
        for name, place in _entries("ros2", options["ros2"], endpoints):
            endpoints[name] = Ros2Endpoint(
                dds, clock, parse_namespace(place), ideal_sight
            )
    if not endpoints:
        raise click.UsageError(
            "at least one player must be served: "
            + " or ".join(
                f"--{interface} PLAYER={address}"
                for interface, address in ADDRESS_FORMATS.items()
            )
        )
    return endpoints


def _entries(
    interface: str,
    entries: Sequence[str],
    taken: "Mapping[str, RobotEndpoint]",
) -> list[tuple[str, str]]:
    """Parse players and addresses; each player may be served once."""
    from ..games.duel_settings import PLAYERS

    found: dict[str, str] = {}
    for entry in entries:
        name, _, address = entry.partition("=")
        known = name in PLAYERS and name not in taken and name not in found
        if not known or not address:
            raise click.BadParameter(
                f"must be {' or '.join(PLAYERS)}={ADDRESS_FORMATS[interface]}"
                f", each player once, got {entry!r}",
                param_hint=f"--{interface}",
            )
        found[name] = address
    return list(found.items())
