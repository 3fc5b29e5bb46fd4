"""Test campaigns of games: teams of strategies, people and tables."""

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from stepaside.cli.main import main
from stepaside.core.player_identity import Role
from stepaside.games.game_file import parse_game
from stepaside.games.game_settings import GameSettings
from stepaside.studies.game_campaign import (
    crowd_row,
    fingerprint_of,
    play_case,
    with_team,
)

TEAMS = """
level = "steps"
duration = 4.0

[[players]]
name = "red"
role = "pursuer"
count = 2

[[players]]
name = "blue"
role = "evader"

[[players]]
name = "guest"
body = "person"
draws_goal = true
"""


def game(**entries: Any) -> GameSettings:
    hunter = {"name": "red", "role": "pursuer", "count": 2}
    prey = {"name": "blue", "role": "evader"}
    common = {"level": "steps", "duration": 4.0, "players": [hunter, prey]}
    return parse_game(common | entries, "game")


def test_a_team_has_one_strategy_and_others_keep_theirs() -> None:
    settings = with_team(game(), Role.PURSUER, "pincer")
    names = [p.strategy for p in settings.resolved().players]
    assert names == ["pincer", "pincer", "evasion"]
    assert with_team(settings, Role.PURSUER, "") == settings


def test_a_record_repeats_and_depends_on_its_case() -> None:
    settings = game()
    first, again, other, teams = (
        play_case(settings, case)
        for case in (
            ("", "", 1),
            ("", "", 1),
            ("", "", 2),
            ("pincer", "team-evasion", 1),
        )
    )
    for record in (first, again, other, teams):
        del record["wall_s"]
    assert first == again
    assert first["closest_m"] != other["closest_m"]
    assert first["closest_m"] != teams["closest_m"]


def test_the_fingerprint_leaves_out_the_seed_only() -> None:
    own = fingerprint_of(game(seed=1))
    assert own == fingerprint_of(game(seed=2))
    assert own != fingerprint_of(game(duration=5.0))


def test_a_crowd_row_counts_success_and_shares_of_the_time() -> None:
    result = {
        "people": 3,
        "success": True,
        "collisions": 0,
        "time_s": 10.0,
        "below_0_45_m_s": 1.0,
        "below_1_2_m_s": 5.0,
    }
    failed = result | {"success": False, "collisions": 2, "time_s": None}
    row = crowd_row("robot", [result, failed], [10.0, 10.0])
    assert (row["success"]["number"], row["collided"]["number"]) == (1, 1)
    assert row["mean_time_s"] == 10.0
    assert row["share_below_0_45"] == pytest.approx(0.1)
    assert row["share_below_1_2"] == pytest.approx(0.5)


def test_the_command_plays_every_pairing_and_continues(tmp_path: Path) -> None:
    file, folder = tmp_path / "teams.toml", tmp_path / "out"
    file.write_text(TEAMS)
    arguments = ["games", str(file), "--seeds", "0:2", "--workers", "1"]
    arguments += ["--pursuer", "pincer", "--pursuer", "assigned"]
    done = CliRunner().invoke(main, [*arguments, "--output", str(folder)])
    assert done.exit_code == 0, done.output
    assert "assigned" in done.output and "blue among 1 people" in done.output
    again = CliRunner().invoke(
        main, [*arguments, "--output", str(folder), "--json"]
    )
    rows = json.loads(again.stdout)["rows"]
    assert [row["pursuers"] for row in rows] == ["pincer", "assigned"]
    assert all(row["games"] == 2 for row in rows)
    bad = CliRunner().invoke(main, ["games", str(file), "--evader", "fly"])
    assert bad.exit_code != 0 and "evader must be one of" in bad.output
