"""Test studies from files, presets and Python, before and after play."""

import sqlite3
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

import stepaside as sa
from stepaside.cli.main import main
from stepaside.games.game_settings import duel, read_game, walk
from stepaside.sim.body_settings import BODIES
from stepaside.studies import tournament
from stepaside.studies.person_encounters import LADDER, Encounter
from stepaside.studies.push_limit import DIRECTIONS, PushTrial, bound_of_push
from stepaside.studies.study_design import PRESETS
from stepaside.theory.value.two_cars import pursuit_bound
from stored_values import compare_stored, content_of, summed


@pytest.fixture(scope="module", autouse=True)
def coarse_table() -> Iterator[None]:
    """The bound is solved on few cells."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tournament, "CELLS", 16)
        pursuit_bound.cache_clear()
        yield
    pursuit_bound.cache_clear()


def keys(study: Any) -> set[str]:
    return {study.key_of(case) for case in study.cases}


def unicycles(**more: Any) -> Any:
    grid = more.pop("grid", {"angle": [0.4, 0.8], "distance": [1.0, 2.0]})
    return sa.make_study("unicycles", {"duration": 1.0}, grid, **more)


def test_cases_are_all_combinations_in_the_order_of_nested_loops() -> None:
    study = unicycles(
        variants={"speed": {"slow": {"evader_speed": 0.05}, "same": {}}},
        cases=[{"law": "saturated"}, {"law": "proportional"}],
    )
    assert len(study.cases) == 16
    assert study.cases[0] == {
        "law": "saturated",
        "speed": "slow",
        "angle": 0.4,
        "distance": 1.0,
    }
    assert [case["distance"] for case in study.cases] == [1.0, 2.0] * 8
    assert study.by == ("law", "speed", "angle", "distance")
    with pytest.raises(IndexError):
        study.cases[16]


def test_a_record_has_what_varies_and_what_came_out() -> None:
    rows = sa.run_study(unicycles()).table()
    assert [(row["angle"], row["distance"]) for row in rows] == [
        (0.4, 1.0),
        (0.4, 2.0),
        (0.8, 1.0),
        (0.8, 2.0),
    ]
    assert all(row["closest_m"]["mean"] <= row["distance"] for row in rows)
    assert all([*row["outcome"]] == ["completed"] for row in rows)


def test_whatever_changes_a_result_changes_its_key(tmp_path: Path) -> None:
    """The content of a strategy file, too."""
    file = tmp_path / "own.py"
    text = (
        Path(__file__).parents[1] / "flows" / "own_strategies.py"
    ).read_text()
    file.write_text(text)
    own = {"evader.strategy": f"{file}:Still", "duration": 1.0}
    before = keys(sa.make_study("duel", own))
    assert keys(sa.make_study("duel", own)) == before
    file.write_text(text + "\n# other\n")
    assert keys(sa.make_study("duel", own)).isdisjoint(before)
    for other in (
        unicycles(grid={"angle": [0.5, 0.9]}),
        sa.make_study("unicycles", {"duration": 2.0}, {"angle": [0.4]}),
        unicycles(variants={"speed": {"slow": {"evader_speed": 0.05}}}),
    ):
        assert keys(other).isdisjoint(keys(unicycles()))
    slow, slower = (
        keys(unicycles(variants={"speed": {"slow": {"evader_speed": v}}}))
        for v in (0.05, 0.04)
    )
    assert slow.isdisjoint(slower)


def test_a_function_of_ones_own_is_a_game() -> None:
    def add(a: int, b: int) -> dict[str, Any]:
        return {"sum": a + b}

    study = sa.make_study(add, {"a": 1}, {"b": [2, 3]}, values=["sum"])
    run = sa.run_study(study)
    assert list(run.records()) == [{"b": 2, "sum": 3}, {"b": 3, "sum": 4}]
    assert [row["sum"]["mean"] for row in run.table()] == [3.0, 4.0]


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"settings": {"speeed": 1.0}}, "unknown entry speeed"),
        ({"settings": {"duration": "long"}}, "duration"),
        ({"grid": {"duration": [1.0, -1.0]}}, "duration"),
        ({"grid": {"evader.strategy": ["nobody"]}}, "nobody"),
        ({"grid": {"body": ["nobodys"]}}, "body must be one of ideal"),
        ({"grid": {"seed": []}}, "at least one"),
        ({"game": "chess"}, "game must be one of duel"),
        ({"game": "walks"}, "did you mean walk?"),
    ],
)
def test_a_bad_study_is_refused_before_it_plays(
    changes: dict[str, Any], words: str
) -> None:
    given: dict[str, Any] = {"game": "duel"} | changes
    with pytest.raises(sa.StepAsideError, match=words):
        sa.make_study(**given)


def test_presets_of_gait_and_body_may_be_changed_further() -> None:
    entries = {"gait": "fast", "body": {"": "hardware", "backlash": 0.1}}
    made = read_game(entries, base=duel())
    assert made.gait.is_fast
    assert made.body.backlash == 0.1
    assert made.body.efficiency == BODIES["hardware"].efficiency


@pytest.mark.parametrize("name", sorted(p.stem for p in PRESETS.iterdir()))
def test_a_preset_is_a_study(name: str) -> None:
    study = sa.load_study(name)
    assert study.name == name and len(study.cases) > 10
    assert study.values
    found: list[Any] = [float(len(study.cases)), *study.by, *study.values]
    for number in range(0, len(study.cases), len(study.cases) // 9):
        found += summed(study.cases[number])
    compare_stored("claims.json", f"study {name}", found)
    shown = CliRunner().invoke(main, ["study", name, "--settings"])
    assert shown.output == (PRESETS / f"{name}.toml").read_text("utf-8")


@pytest.mark.parametrize("drawn", [True, False])
@pytest.mark.parametrize("reaction", LADDER)
def test_an_encounter_is_the_game_that_is_stored(
    reaction: str, drawn: bool
) -> None:
    game = duel(pursuer={"body": "person"}, gait="fast", seed=4)
    met = Encounter(game, 0.7, 30.0, 0.3, reaction, 1.5, drawn).person
    settings = met.settings
    (person, robot), start = settings.players, settings.start
    shown = [met.change_at, settings.duration, person.person, start]
    found = [*content_of([*shown, robot.evasion])]
    compare_stored("claims.json", f"met {reaction} {drawn}", found)


def test_bounds_of_pushes_are_those_that_are_stored() -> None:
    found = [
        bound_of_push(PushTrial(walk(), direction, phase))
        for direction in DIRECTIONS
        for phase in (0.1, 0.4, 0.8)
    ]
    compare_stored("claims.json", "bounds of pushes", found)


def test_a_preset_is_changed_by_words() -> None:
    study = sa.load_study(
        "robustness",
        [
            "disturbance=friction*,mass 3 %",
            "method=mpc",
            "seed=4:6",
            "duration=3",
        ],
    )
    cases = list(study.cases)
    assert len(cases) == 7 * 2
    assert {case["method"] for case in cases} == {"mpc"}
    assert {case["seed"] for case in cases} == {4, 5}
    names = sa.load_study(
        "rating", ["evader=pursuit(gain=2, lead=1),sharp", "floor=open*"]
    )
    assert [case["evader"] for case in list(names.cases)[::200]] == [
        "pursuit(gain=2, lead=1)",
        "sharp",
    ]


def test_a_tournament_is_stored_as_a_table(tmp_path: Path) -> None:
    changes = ["evader=look-ahead,evasion", "seed=0:2", "duration=5.47"]
    file = tmp_path / "games.sqlite"
    run = sa.run_study(sa.load_study("tournament", changes), file)
    (ahead, evasion) = run.table()
    assert ahead["survived"] == evasion["survived"]
    assert ahead["of_bound"]["mean"] > 0.0
    with sqlite3.connect(file) as results:
        rows = results.execute("SELECT evader, seed, survived FROM results")
        assert rows.fetchall() == [
            (evader, seed, 1)
            for evader in ("look-ahead", "evasion")
            for seed in (0, 1)
        ]
