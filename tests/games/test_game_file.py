"""Test game files: players, defaults of their robots, and bad input."""

from pathlib import Path
from typing import Any

import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.core.player_identity import Role
from stepaside.games.configuration_file import (
    dump_configuration,
    read_settings,
)
from stepaside.games.game_file import load_game, parse_game
from stepaside.games.game_settings import MOST_ROBOTS, GameSettings
from stepaside.games.robot_settings import LEGS_GAIT

EXAMPLES = Path(__file__).parents[2] / "examples"
HUNTER = {"name": "red", "role": "pursuer"}
PREY = {"name": "blue", "role": "evader"}


def game(*players: dict[str, Any], **entries: Any) -> GameSettings:
    return parse_game(entries | {"players": list(players)}, "game")


def test_players_have_the_gait_of_their_robot_changed_by_the_file() -> None:
    settings = game(HUNTER | {"gait": {"speed": 0.08}}, PREY, seed=4)
    red, blue = settings.players
    assert red.gait.speed == 0.08 and blue.gait.speed == 0.1
    assert red.gait.gain == blue.gait.gain and red.control == blue.control
    legs = game(HUNTER | {"legs": {"network": "walk.onnx"}}, PREY).players[0]
    assert legs.gait.speed == LEGS_GAIT["speed"] and legs.legs.walks
    assert red.identity.role is Role.PURSUER and red.identity.team == "pursuer"
    assert [p.strategy for p in settings.resolved().players] == [
        "pursuit",
        "evasion",
    ]
    assert settings.seed == 4 and settings.robots == ("red", "blue")
    assert settings.opponents_of("red") == ("blue",)


def test_the_configuration_of_a_game_is_read_back_equal() -> None:
    settings = game(
        HUNTER | {"start": [0.0, 1.0, 0.5], "sight": {"delay": 0.1}},
        PREY | {"goal": [2.0, 0.0]},
        {"name": "guest", "body": "person", "crowd": {"speed": 1.0}},
        room={"width": 4.0, "depth": 3.0},
    )
    text = dump_configuration(settings)
    assert read_settings(GameSettings, text, "text") == settings.resolved()


def test_an_entry_with_a_count_is_that_many_players() -> None:
    guests = {"name": "guest", "count": 3, "body": "person"}
    settings = game(HUNTER, PREY, guests | {"draws_goal": True})
    assert settings.names == ("red", "blue", "guest-1", "guest-2", "guest-3")
    assert all(p.draws_goal for p in settings.players[2:])


def test_changes_replace_settings_before_they_are_checked(
    tmp_path: Path,
) -> None:
    file = tmp_path / "many.toml"
    file.write_text(
        '[[players]]\nname = "red"\nrole = "pursuer"\n'
        '[[players]]\nname = "blue"\nrole = "evader"\n'
        f"count = {MOST_ROBOTS}\n"
    )
    with pytest.raises(ConfigurationError, match="robots in physics"):
        load_game(file)
    assert load_game(file, level="steps", seed=9).seed == 9


@pytest.mark.parametrize(
    "name", sorted(EXAMPLES.glob("*.toml")), ids=lambda file: file.stem
)
def test_the_example_games_are_valid(name: Path) -> None:
    assert load_game(name).players


def test_cameras_look_for_a_player_of_a_colour() -> None:
    watcher = HUNTER | {"senses": "cameras", "target": "grey"}
    with pytest.raises(ConfigurationError, match="target must be a pursuer"):
        game(watcher, {"name": "grey"})
    prey = {"name": "blue", "role": "evader"}
    with pytest.raises(ConfigurationError, match="more than two robots"):
        game(watcher | {"target": "blue"}, prey, {"name": "grey"})
