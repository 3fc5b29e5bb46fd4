"""Shields of the robots of a game, with what is known of all bodies."""

from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path

from ..locomotion.departures import load_departure
from ..robots.description import load_robot
from ..strategies.body_departure import BodyDeparture
from ..strategies.shield import PERSON_REACH, ShieldedStrategy
from ..strategies.strategy import Strategy
from .player_settings import PlayerSettings, RobotSettings


def shielded(strategy: Strategy, own: RobotSettings) -> Strategy:
    """Return a strategy, within a shield if the settings enable one."""
    if not own.shield.enabled:
        return strategy
    return ShieldedStrategy(strategy, own.shield, departure_of(own))


def departure_of(own: RobotSettings) -> BodyDeparture | None:
    """Return the departure of a robot on its legs; None if not measured."""
    robot = load_robot(own.robot)
    if not own.legs.network:
        return load_departure(robot, own.gait)
    from ..locomotion.policy.velocity_response import load_response

    response = load_response(Path(robot.folder), Path(own.legs.network))
    return None if response is None else response.departure


def with_contacts(
    players: Iterable[PlayerSettings],
    opponents_of: Callable[[PlayerSettings], Iterable[PlayerSettings]],
) -> tuple[PlayerSettings, ...]:
    """Return players whose shields have a contact distance.

    By default it is the sum of the reaches of the outlines of both bodies.
    """
    found = []
    for own in players:
        if own.shield.enabled and own.shield.contact is None:
            others = map(reach_of, opponents_of(own))
            contact = reach_of(own) + max(others, default=PERSON_REACH)
            own = replace(own, shield=replace(own.shield, contact=contact))
        found.append(own)
    return tuple(found)


def reach_of(own: PlayerSettings) -> float:
    """Return the radius around a player that contains its body, in [m]."""
    if own.body != "robot":
        return PERSON_REACH
    departure = departure_of(own)
    if departure is not None:
        return departure.reach
    return load_robot(own.robot).place.reach
