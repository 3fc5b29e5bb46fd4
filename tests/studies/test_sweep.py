"""Test studies from files: cases, keys, rows and messages."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.games.duel_settings import DuelSettings
from stepaside.strategies.table_cache import pursuit_bound
from stepaside.studies import tournament_record
from stepaside.studies.study import run_study
from stepaside.studies.sweep import (
    Sweep,
    load_sweep,
    sweep_rows,
    sweep_study,
)

UNICYCLES = """
game = "unicycles"
[settings]
duration = 20.0
[grid]
evader_gain = [0.1, 0.2]
bearing = {first = 0.0, last = 1.0, number = 3}
"""


@pytest.fixture(scope="module", autouse=True)
def coarse_table(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """The bound is solved on few cells."""
    patch = pytest.MonkeyPatch()
    patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
    patch.setattr(tournament_record, "CELLS", 16)
    pursuit_bound.cache_clear()
    yield
    patch.undo()
    pursuit_bound.cache_clear()


def sweep_of(folder: Path, text: str) -> Sweep:
    file = folder / "study.toml"
    file.write_text(text)
    return load_sweep(file)


def test_a_grid_has_every_combination(tmp_path: Path) -> None:
    sweep = sweep_of(tmp_path, UNICYCLES)
    changes = [sweep.changes(case) for case in sweep.cases]
    assert changes == [
        {"evader_gain": gain, "bearing": bearing}
        for gain in (0.1, 0.2)
        for bearing in (0.0, 0.5, 1.0)
    ]


def test_settings_of_a_duel_are_those_of_its_configuration(
    tmp_path: Path,
) -> None:
    text = """
    game = "duel"
    settings.duration = 3.0
    settings.strategy.saturated = true
    [grid]
    strategy.safety_radius = [0.6, 0.8]
    seed = "3:5"
    """
    sweep = sweep_of(tmp_path, text)
    found = [sweep.settings(case) for case in sweep.cases]
    assert all(isinstance(each, DuelSettings) for each in found)
    assert [each.seed for each in found] == [3, 4, 3, 4]
    assert [each.strategy.safety_radius for each in found] == [
        *(0.6, 0.6, 0.8, 0.8)
    ]
    assert {each.duration for each in found} == {3.0}
    assert all(each.strategy.saturated for each in found)


def test_a_list_of_cases_may_be_combined_with_a_grid(tmp_path: Path) -> None:
    text = """
    game = "unicycles"
    [[cases]]
    evader_gain = 0.1
    [[cases]]
    evader_gain = 0.3
    angle = 1.0
    [grid]
    bearing = [0.0, 0.5]
    """
    sweep = sweep_of(tmp_path, text)
    assert [sweep.changes(case) for case in sweep.cases] == [
        {"evader_gain": 0.1, "bearing": 0.0},
        {"evader_gain": 0.1, "bearing": 0.5},
        {"evader_gain": 0.3, "angle": 1.0, "bearing": 0.0},
        {"evader_gain": 0.3, "angle": 1.0, "bearing": 0.5},
    ]


def test_whatever_changes_a_case_changes_its_key(tmp_path: Path) -> None:
    keys: set[str] = set()
    texts = (
        UNICYCLES,
        UNICYCLES.replace("20.0", "21.0"),
        UNICYCLES.replace("[0.1, 0.2]", "[0.11, 0.21]"),
    )
    for text in texts:
        study = sweep_study(sweep_of(tmp_path, text))
        keys |= {study.key_of(case) for case in study.cases}
    assert len(keys) == 18
    own = tmp_path / "own.py"
    text = f'game = "duel"\ngrid.evader_strategy = ["{own}:Own"]'
    for content in ("class Own: ...", "class Own: pass"):
        own.write_text(content)
        sweep = Sweep("duel", {}, ("evader_strategy",), ([f"{own}:Own"],))
        study = sweep_study(sweep)
        keys.add(study.key_of(study.cases[0]))
    assert len(keys) == 20 and text


def test_rows_are_over_seeds(tmp_path: Path) -> None:
    text = """
    game = "tournament"
    settings.game.duration = 4.0
    [grid]
    evader = ["optimal", "look-ahead"]
    seed = "0:3"
    """
    sweep = sweep_of(tmp_path, text)
    run = run_study(sweep_study(sweep))
    rows = sweep_rows(sweep, run.items(), ["closest_m", "survived_s"])
    assert [row["settings"] for row in rows] == [
        {"evader": "optimal"},
        {"evader": "look-ahead"},
    ]
    for row, records in zip(
        rows, (list(run.records())[:3], list(run.records())[3:]), strict=True
    ):
        assert row["cases"] == sum(row["outcomes"].values()) == 3
        closest = [record["closest_m"] for record in records]
        assert row["closest_m"]["mean"] == pytest.approx(sum(closest) / 3)
        assert row["closest_m"]["least"] == min(closest)
    with pytest.raises(ConfigurationError, match="value must be one of"):
        sweep_rows(sweep, run.items(), ["nothing"])


def test_a_game_of_unicycles_reaches_its_circle(tmp_path: Path) -> None:
    text = 'game = "unicycles"\n[grid]\nduration = [400.0]'
    (record,) = run_study(sweep_study(sweep_of(tmp_path, text))).records()
    assert record["distance_m"] == pytest.approx(0.9003, abs=1e-3)
    assert json.loads(json.dumps(record)) == record
