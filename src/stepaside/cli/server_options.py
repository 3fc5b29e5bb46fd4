"""Where robots of our world are offered, by the options of a command."""

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from ..games.robot_offers import Offer

PLACES = {
    "lola": "ADDRESS",
    "naoqi": "tcp://HOST:PORT",
    "naoqi-joints": "tcp://HOST:PORT",
    "ros2": "/NAMESPACE",
}


def offers_of(
    options: Mapping[str, Any], stack: ExitStack, *, ideal_sight: bool
) -> "dict[str, Offer]":
    """What is offered to whom.

    Args:
        options: Of the command: for each language the players and their
            places, ``domain`` and ``network``.
        stack: Closes what has to be closed at the end.
        ideal_sight: Whether the true line of sight is offered.
    """
    from ..drivers.lola.lola_address import parse_address
    from ..games.robot_offers import LolaOffer

    offers: dict[str, Offer] = {}
    for name, place in _entries("lola", options["lola"], offers):
        offers[name] = LolaOffer(parse_address(place), ideal_sight)
    if options["naoqi"]:
        from ..drivers.naoqi.naoqi_url import parse_url
        from ..games.naoqi_offers import NaoqiOffer

        for name, place in _entries("naoqi", options["naoqi"], offers):
            offers[name] = NaoqiOffer(parse_url(place), ideal_sight)
    if options["naoqi_joints"]:
        from ..drivers.naoqi.naoqi_url import parse_url
        from ..games.naoqi_offers import NaoqiJointsOffer

        joints = options["naoqi_joints"]
        for name, place in _entries("naoqi-joints", joints, offers):
            offers[name] = NaoqiJointsOffer(parse_url(place), ideal_sight)
    if options["ros2"]:
        from ..drivers.ros2.namespaces import parse_namespace
        from ..drivers.ros2.ros2_server import WorldClock
        from ..games.ros2_offers import Ros2Offer
        from .ros2_hints import join_domain

        dds = join_domain(options)
        stack.callback(dds.close)
        clock = WorldClock(dds)
        for name, place in _entries("ros2", options["ros2"], offers):
            offers[name] = Ros2Offer(
                dds, clock, parse_namespace(place), ideal_sight=ideal_sight
            )
    if not offers:
        raise click.UsageError(
            "somebody must be offered: "
            + " or ".join(f"--{k} PLAYER={v}" for k, v in PLACES.items())
        )
    return offers


def _entries(
    language: str, entries: Sequence[str], taken: "Mapping[str, Offer]"
) -> list[tuple[str, str]]:
    """Players and places, each player once in all languages."""
    from ..games.duel_settings import PLAYERS

    found: dict[str, str] = {}
    for entry in entries:
        name, _, place = entry.partition("=")
        known = name in PLAYERS and name not in taken and name not in found
        if not known or not place:
            raise click.BadParameter(
                f"must be {' or '.join(PLAYERS)}={PLACES[language]}, each "
                f"once, got {entry!r}",
                param_hint=f"--{language}",
            )
        found[name] = place
    return list(found.items())
