"""Scenery of a game: everything but robots, and the colours of players."""

from collections.abc import Collection, Mapping

import mujoco

from ..core.player_identity import Colour, Rgb, Role, shades_of
from ..sim.camera_settings import SceneSettings
from ..sim.world import COLOURS
from .game_settings import GameSettings

BASE: dict[Role, Rgb] = {
    Role.PURSUER: (0.80, 0.16, 0.14),
    Role.EVADER: (0.10, 0.36, 0.75),
    Role.BYSTANDER: (0.45, 0.46, 0.48),
}


def colours_of_players(settings: object) -> Mapping[str, Colour]:
    """Return the colours of players by name, of settings of any game.

    In a game with cameras, which know one colour of each role, robots have
    the colour of their role; otherwise players of one role have shades.
    """
    if not isinstance(settings, GameSettings):
        return COLOURS
    shades = shades_of(settings.identities, BASE)
    if settings.sensing_by("cameras"):
        roles = {n: own.role for n, own in settings.identities.items()}
        shades |= {name: BASE[roles[name]] for name in settings.robots}
    return {name: (*colour, 1.0) for name, colour in shades.items()}


def furnish_game(
    spec: mujoco.MjSpec,
    settings: GameSettings,
    templates: Collection[str] = (),
) -> None:
    """Add obstacles, people, templates and cameras of a game to a model.

    In a duel people wear their own clothes, and cameras see walls and things.
    The settings have all starts; ``templates`` are robots shown as such.
    """
    colours, is_duel = colours_of_players(settings), settings.game == "duel"
    if settings.room is not None:
        from ..sim.room_furnishing import add_solids

        add_solids(spec, settings.room)
    seeing = [
        p for p in settings.sensing_by("cameras") if p.name not in templates
    ]
    if seeing:
        from ..sim.camera_scene import add_scene, wall_distance

        starts, walls = [p.start for p in settings.players], 0.0
        if is_duel:
            walls = wall_distance(settings.scene.walls, starts)
        add_scene(
            spec,
            settings.scene if is_duel else SceneSettings(),
            seeing[0].robot,
            walls=walls,
            wearers=[p.name for p in seeing],
        )
    for player in settings.players:
        if player.body == "robot" and player.name not in templates:
            continue
        from ..sim.person_body import SHIRT, add_person, add_template

        colour = colours[player.name]
        if player.body == "person":
            shirt, solid = SHIRT if is_duel else colour, player.person.solid
            add_person(spec, player.name, shirt=shirt, solid=solid)
        else:
            add_template(spec, player.name, colour)
