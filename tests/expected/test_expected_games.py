"""Test what games, strategies, environments and studies should do."""

import json
import os
import pickle
import sqlite3
import sys
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

import stepaside as sa
from expected.asking import GAME, answer, command, own_evader
from legs_robot import nao_on_legs
from stepaside.cli.tables import print_run
from stepaside.envs import ParallelGame  # registers the environments, too
from stepaside.games.served_duel import serve_duel

SHORT = sa.duel(duration=1.2, start=sa.StartSettings(distance=0.7))
OPEN: dict[str, Any] = {"level": "unicycle", "arenas": 4, "duration": 8.0}


@pytest.fixture
def file(tmp_path: Path) -> Path:
    made = tmp_path / "game.toml"
    made.write_text(GAME)
    return made


def test_a_box_ends_a_game_in_steps(tmp_path: Path) -> None:
    file = tmp_path / "box.toml"
    file.write_text("""
level = "steps"
duration = 20.0
[room]
width = 6.0
depth = 6.0
obstacles = [{ x = 1.0, y = 0.0, width = 0.4, depth = 0.4 }]
[[players]]
name = "red"
role = "pursuer"
start = [-2.5, 0.0, 0.0]
[[players]]
name = "blue"
role = "evader"
strategy = "walk"
start = [-0.5, 0.0, 3.14159]
""")
    assert answer("run", "game", file)["outcome"] != "completed"


def test_a_step_takes_the_same_time_in_games_and_tournaments(
    file: Path, tmp_path: Path
) -> None:
    output = tmp_path / "out.sqlite"
    own = own_evader(tmp_path / "own.py", turn=0.0)
    words: list[object] = ["study", "tournament", "--workers", 1]
    for change in (f"evader={own}", "floor=open", "seed=0:1"):
        words += ["--set", change]
    command(*words, "--set", "duration=10", "--output", output)
    with sqlite3.connect(output) as table:
        walked, lasted = table.execute(
            "SELECT walked_m, survived_s FROM results"
        ).fetchone()
    file.write_text(GAME.replace("1.0", "10.0") + f'strategy = "{own}"')
    blue = answer("run", "game", file, "--level", "steps")["players"]["blue"]
    assert blue["path_m"] / 10.0 == pytest.approx(walked / lasted, rel=0.05)


def test_a_served_duel_moves_robots_on_learned_legs(tmp_path: Path) -> None:
    robot = str(nao_on_legs(tmp_path / "nao", gain=0.3))
    settings = SHORT.changed(robot=robot, body=sa.BODIES["delayed"])
    dds = pytest.importorskip("stepaside.drivers.ros2_dds")
    with closing(dds.DdsParticipant(20 + os.getpid() % 200)) as joined:
        served, _ = serve_duel(settings, joined, {}, lock_step=True)
    played = sa.run_game(settings)
    for name in ("pursuer", "evader"):
        np.testing.assert_array_equal(
            served.tracks[name].torso, played.tracks[name].torso
        )


def test_a_crowd_that_is_touched_is_no_success(tmp_path: Path) -> None:
    """A person walks through a robot that stands."""
    file = tmp_path / "crowd.toml"
    file.write_text("""
level = "unicycle"
duration = 6.0
[[players]]
name = "blue"
role = "evader"
strategy = "stand"
start = [0.0, 0.0, 0.0]
[[players]]
name = "guest"
role = "pursuer"
body = "person"
person = { path = "straight", speed = 1.0 }
start = [2.0, 0.0, 3.14159]
""")
    met = answer("run", "game", file)["players"]["blue"]["crowd"]
    assert met["collisions"] == 1 and not met["success"]


@pytest.mark.slow
def test_the_closest_approach_of_a_team_game_is_that_of_opponents(
    tmp_path: Path,
) -> None:
    file = tmp_path / "team.toml"
    file.write_text("""
level = "unicycle"
duration = 0.2
[[players]]
name = "red"
role = "pursuer"
start = [0.0, 0.0, 0.0]
[[players]]
name = "ruby"
role = "pursuer"
start = [0.0, 0.4, 0.0]
[[players]]
name = "blue"
role = "evader"
start = [2.0, 0.0, 3.14159]
""")
    (row,) = answer("study", file, "--set", "seed=0:2")["rows"]
    assert row["closest_m"]["min"] > 1.9


def test_the_outcome_of_an_environment_is_a_word() -> None:
    """The evader stands, and the pursuer walks into it."""
    duel = sa.duel(start=sa.StartSettings(distance=0.5))
    env = gymnasium.make(
        "stepaside/Evade-v0", level="physics", duel=duel, duration=20.0
    )
    env.reset(seed=1)
    over = False
    while not over:
        *_, ended, late, info = env.step(np.zeros(2, np.float32))
        over = ended or late
    env.close()
    assert info["outcome"] in ("contact", "fall")


@pytest.mark.parametrize("seed", [2**31, 2**70])
def test_any_seed_begins_an_episode(file: Path, seed: int) -> None:
    single = gymnasium.make("stepaside/Evade-v0", **OPEN)
    several: Any = gymnasium.make_vec(
        "stepaside/Evade-v0",
        num_envs=2,
        vectorization_mode="vector_entry_point",
        **OPEN,
    )
    first, _ = single.reset(seed=seed)
    second, _ = single.reset(seed=seed + 1)
    both, _ = several.reset(seed=seed)
    np.testing.assert_array_equal(both, [first, second])
    again, _ = several.reset(seed=[seed, seed + 1])
    np.testing.assert_array_equal(both, again)
    found, _ = ParallelGame(file).reset(seed=seed)
    assert set(found) == {"red", "blue"}


def test_a_vector_environment_can_be_pickled() -> None:
    envs = gymnasium.make_vec(
        "stepaside/Evade-v0",
        num_envs=2,
        vectorization_mode="vector_entry_point",
        **OPEN,
    )
    again = pickle.loads(pickle.dumps(envs))
    np.testing.assert_array_equal(
        envs.reset(seed=3)[0], again.reset(seed=3)[0]
    )


def test_learners_must_differ(file: Path) -> None:
    with pytest.raises(sa.StepAsideError, match="learners must be different"):
        ParallelGame(file, learners=["blue", "blue"])


@pytest.mark.parametrize("number", [2, 15, 16])
def test_discrete_headings_are_evenly_spaced_on_the_circle(
    number: int,
) -> None:
    env: Any = gymnasium.make(
        "stepaside/Evade-v0", action="discrete", headings=number, **OPEN
    ).unwrapped
    *headings, stand = env.settings.action_headings
    assert stand is None and len(headings) == number
    turns = np.diff([*headings, headings[0] + 2.0 * np.pi])
    np.testing.assert_allclose(turns, 2.0 * np.pi / number)


@pytest.mark.slow
def test_a_parameter_of_an_own_strategy_is_an_axis(tmp_path: Path) -> None:
    own = own_evader(tmp_path / "own.py")
    study = tmp_path / "study.toml"
    names = [f"{own}(turn={turn})" for turn in (0.4, 0.8)]
    study.write_text(
        'game = "duel"\n[grid]\nevader = '
        f'{json.dumps(names)}\n[settings]\nlevel = "steps"\nduration = 1.0\n'
    )
    assert len(answer("study", study)["rows"]) == 2


def test_strategies_of_two_files_of_one_name_can_be_pickled(
    tmp_path: Path,
) -> None:
    made: list[Any] = []
    for number, folder in enumerate(("a", "b")):
        (tmp_path / folder).mkdir()
        mine = tmp_path / folder / "mine.py"
        made.append(sa.load_strategy(own_evader(mine, 0.1 + number)))
    again = [pickle.loads(pickle.dumps(each)) for each in made]
    assert [each.turn for each in again] == [0.1, 1.1]


def test_a_study_in_python_shows_its_progress(
    capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a terminal, as the commands do."""
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    sa.run_study(sa.make_study("duel", {"duration": 0.2}))
    assert "1 of 1 cases" in capfd.readouterr().err


def test_a_study_of_too_many_cases_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "study.toml"
    file.write_text(
        'game = "unicycles"\n[grid]\nseed = "0:1000000"\n'
        "duration = { first = 1.0, last = 2.0, number = 1000000000000 }\n"
    )
    done = command("study", file)
    assert done.exit_code == 2 and "at most 10000000 cases" in done.stderr


def test_a_file_without_records_is_not_merged(tmp_path: Path) -> None:
    part = tmp_path / "games.sqlite"
    part.write_text("no records")
    whole = tmp_path / "whole.sqlite"
    done = command("study", "duels", part, "--output", whole)
    assert done.exit_code == 2
    assert "must be a SQLite file with records" in done.stderr
    assert not whole.exists()


@pytest.mark.slow
def test_games_are_written_to_any_path(file: Path, tmp_path: Path) -> None:
    output = tmp_path / "out\udcff.sqlite"  # a byte that is not UTF-8
    words = ("study", file, "--set", "seed=0:2", "--output", output)
    assert command(*words).exit_code == 0
    assert output.stat().st_size > 0


@pytest.fixture(scope="module")
def circled() -> Iterator[sa.Run]:
    run = sa.run_game(replace(SHORT, duration=3.0))
    assert run.theory is not None
    yield run


@pytest.mark.parametrize(("since", "marked"), [(1.0, False), (2.5, True)])
def test_values_from_before_the_circle_are_marked(
    circled: sa.Run,
    since: float,
    marked: bool,
    capsys: pytest.CaptureFixture[str],
) -> None:
    summary = replace(circled.summary, converged_at_s=since)
    print_run(replace(circled, summary=summary))
    assert ("measured from 2.0 s on" in capsys.readouterr().out) is marked
