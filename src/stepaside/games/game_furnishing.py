"""Everything but robots in the world of a game, and its colours."""

from collections.abc import Collection

import mujoco

from ..core.player_colours import Rgb, shades_of
from ..core.player_identity import Role
from ..sim.obstacle_geoms import add_solids
from ..sim.pedestrian_appearance import FIGURES, Colour
from ..sim.person_body import add_person
from ..sim.template_body import add_template
from .game_settings import GameSettings

BASE: dict[Role, Rgb] = {
    Role.PURSUER: (0.80, 0.16, 0.14),
    Role.EVADER: (0.10, 0.36, 0.75),
    Role.BYSTANDER: (0.45, 0.46, 0.48),
}


def colours_in_world(settings: GameSettings) -> dict[str, Colour]:
    """Return the colour of each player in images, red to opacity."""
    shades = shades_of(settings.identities, BASE)
    return {name: (*colour, 1.0) for name, colour in shades.items()}


def furnish_game(
    spec: mujoco.MjSpec,
    settings: GameSettings,
    *,
    templates: Collection[str] = (),
) -> None:
    """Add everything but robots to the world of a game.

    Args:
        spec: Specification of the world.
        settings: Settings of the game.
        templates: Names of robots that are shown as templates.
    """
    colours = colours_in_world(settings)
    if settings.room is not None:
        add_solids(spec, settings.room)
    for player in settings.players:
        if player.body == "person":
            figure = FIGURES[player.person.figure]
            shirt = colours[player.name]
            add_person(spec, player.name, figure, shirt=shirt)
        elif player.body != "robot" or player.name in templates:
            add_template(spec, player.name, colours[player.name])
