"""Shields of the robots of a game, with what is known of all bodies."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from ..locomotion.departures import load_departure
from ..robots.description import load_robot
from ..strategies.body_departure import BodyDeparture
from ..strategies.shield import PERSON_REACH, ShieldedStrategy
from ..strategies.strategy import Strategy
from .player_settings import PlayerSettings, RobotSettings


def shielded(
    strategy: Strategy,
    own: RobotSettings,
    opponents: Iterable[PlayerSettings] = (),
) -> Strategy:
    """Return a strategy, within a shield if the settings enable one.

    A strategy that has a shield, as an object or from a file, keeps that one;
    what it does not say of the bodies is filled in alike.
    """
    if not isinstance(strategy, ShieldedStrategy):
        if not own.shield.enabled:
            return strategy
        strategy = ShieldedStrategy(strategy, own.shield)
    own = replace(own, shield=replace(strategy.shield, enabled=True))
    if isinstance(own, PlayerSettings):
        own = with_contact(own, opponents)
    departure = strategy.departure or departure_of(own)
    return replace(strategy, shield=own.shield, departure=departure)


def departure_of(own: RobotSettings) -> BodyDeparture | None:
    """Return the departure of a robot on its legs; None if not measured."""
    robot = load_robot(own.robot)
    if not own.legs.network:
        return load_departure(robot, own.gait)
    from ..locomotion.policy.velocity_response import load_response

    response = load_response(Path(robot.folder), Path(own.legs.network))
    return None if response is None else response.departure


def with_contact(
    own: PlayerSettings, opponents: Iterable[PlayerSettings]
) -> PlayerSettings:
    """Return a player whose shield, if enabled, has a contact distance.

    By default it is the sum of the reaches of the outlines of both bodies.
    """
    if own.shield.contact is not None or not own.shield.enabled:
        return own
    others = max(map(reach_of, opponents), default=PERSON_REACH)
    contact = reach_of(own) + others
    return replace(own, shield=replace(own.shield, contact=contact))


def reach_of(own: PlayerSettings) -> float:
    """Return the radius around a player that contains its body, in [m]."""
    if own.body != "robot":
        return PERSON_REACH
    departure = departure_of(own)
    if departure is not None:
        return departure.reach
    return load_robot(own.robot).place.reach
