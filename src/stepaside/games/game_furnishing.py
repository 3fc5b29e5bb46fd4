"""Scenery of a match: everything but robots, and their colours."""

from collections.abc import Callable, Collection, Mapping
from functools import partial
from typing import NamedTuple

import mujoco

from ..core.player_identity import Colour, Rgb, Role, shades_of
from ..robots.description import load_robot
from ..robots.head import load_head
from ..sim.camera_settings import SceneSettings
from ..sim.person_body import SHIRT, add_person, add_template
from ..sim.room_furnishing import (
    Furnish,
    add_solids,
    furnisher,
    obstacle_mover,
)
from ..sim.world import COLOURS
from .game_settings import GameSettings

Mover = Callable[[float], None]  # moves bodies to where they are at a time [s]
MakeMover = Callable[[mujoco.MjModel, mujoco.MjData], Mover]

WALL_MARGIN = 1.0  # smallest distance of a start from the walls, in [m]
WALL_DISTANCE = 3.5  # from a start to walls moved for it: camera range, [m]
BASE: dict[Role, Rgb] = {
    Role.PURSUER: (0.80, 0.16, 0.14),
    Role.EVADER: (0.10, 0.36, 0.75),
    Role.BYSTANDER: (0.45, 0.46, 0.48),
}


def colours_in_world(settings: GameSettings) -> dict[str, Colour]:
    """Return the colour of each player in images, red to opacity.

    In a game with cameras, which know one colour of each role, robots have
    the colour of their role; otherwise players of one role have shades.
    """
    shades = shades_of(settings.identities, BASE)
    if settings.sensing_by("cameras"):
        roles = {n: own.role for n, own in settings.identities.items()}
        shades |= {name: BASE[roles[name]] for name in settings.robots}
    return {name: (*colour, 1.0) for name, colour in shades.items()}


def colours_of_players(settings: object) -> Mapping[str, Colour]:
    """Return the colours of players by name, of settings of any game."""
    if isinstance(settings, GameSettings):
        return colours_in_world(settings)
    return COLOURS


class Scenery(NamedTuple):
    """Everything but robots in the world of a match.

    Attributes:
        furnishings: Functions that add it to a model.
        make_movers: Functions of model and data that return the functions
            which move obstacles and people.
        colours: Colours of robots by name; by default those of their roles.
    """

    furnishings: tuple[Furnish, ...]
    make_movers: tuple[MakeMover, ...] = ()
    colours: Mapping[str, Colour] | None = None

    def furnish(self, spec: mujoco.MjSpec) -> None:
        """Add everything but robots to a model."""
        for add in self.furnishings:
            add(spec)

    def movers_in(
        self, model: mujoco.MjModel, data: mujoco.MjData
    ) -> list[Mover]:
        """Return the functions of the time [s] that move bodies of a world."""
        return [make(model, data) for make in self.make_movers]


def scenery_of(
    settings: GameSettings, *, templates: Collection[str] = ()
) -> Scenery:
    """Return obstacles, people, templates and cameras of a game.

    In a duel people wear their own clothes, and cameras see walls and things.

    Args:
        settings: Settings of the game, with the initial poses filled in.
        templates: Names of robots that are shown as templates.
    """
    colours = colours_in_world(settings)
    room, furnishings, movers = settings.room, [], []
    if room is not None:
        furnishings.append(lambda spec: add_solids(spec, room))
        if room.moving:
            movers.append(partial(obstacle_mover, room=room))
    seeing = [
        p for p in settings.sensing_by("cameras") if p.name not in templates
    ]
    duel = settings.game == "duel"
    if seeing:
        furnishings.append(
            furnisher(
                settings.scene if duel else SceneSettings(),
                load_head(load_robot(seeing[0].robot)),
                walls=_wall_distance(settings) if duel else 0.0,
                wearers=[p.name for p in seeing],
            )
        )

    def furnish_players(spec: mujoco.MjSpec) -> None:
        for player in settings.players:
            if player.body == "person":
                shirt = SHIRT if duel else colours[player.name]
                solid = player.person.solid
                add_person(spec, player.name, shirt=shirt, solid=solid)
            elif player.body != "robot" or player.name in templates:
                add_template(spec, player.name, colours[player.name])

    return Scenery((*furnishings, furnish_players), tuple(movers), colours)


def _wall_distance(settings: GameSettings) -> float:
    """Return the distance of the walls from the origin, in [m].

    A player that began outside the walls would pass through one, undetected
    until then. If a start is not well inside, the walls are moved beyond the
    range of a depth camera at that start.
    """
    walls = settings.scene.walls
    reach = max(abs(c) for own in settings.players for c in own.start[:2])
    if not walls or reach + WALL_MARGIN <= walls:
        return walls
    return reach + WALL_DISTANCE
