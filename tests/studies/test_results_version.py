"""Test that the results version is raised when games turn out otherwise.

Short games of ``tests/data/games.toml`` that use most settings, strategies
and sensors, and studies of games without bodies. A change in the last bits is
none; if a value changes by more, raise ``RESULTS`` and store the new values::

    PYTHONPATH=src:tests python tests/studies/test_results_version.py
"""

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stepaside.studies.results_version import RESULTS
from stepaside.studies.study import run_study
from stepaside.studies.study_design import load_study
from stored_games import GAMES, run_of
from stored_values import DATA

pytestmark = pytest.mark.xdist_group("stored-games")
STORED = DATA / "games.json"  # with the version that the values belong to
COLUMNS = 12  # of an array that are stored
OF_THE_MACHINE = ("real_time_factor", "median_us", "p99_us")
STUDIES: dict[str, tuple[str, str, list[float]]] = {
    "tournament": (
        "closest_m",
        'seed = "1:4"\n[settings]\nduration = 41.025\nroom.discs = 3',
        [0.761491795, 0.781406943, 0.46711146],
    ),
    "unicycles": (
        "distance_m",
        "aim = [0.1, 0.5, 2.0]\n[settings]\nduration = 20.0\nspeed = 0.1\n"
        "gain = 0.2\ndistance = 1.0\nbearing = 0.0",
        [0.777901202, 0.834319326, 1.16095572],
    ),
}
"""Value, grid with settings, and the three values of each kind of game."""


def play(game: str) -> dict[str, list[float]]:
    """Return the numbers of the summary, and mean columns of the tracks."""
    run = run_of(game)
    found = {"duration": [run.duration]} | dict(leaves(asdict(run.summary)))
    for name, values in run.arrays().items():
        rows = np.nan_to_num(values.astype(np.float64), nan=-1.0)
        means = rows.mean(axis=0) if len(rows) else np.empty(0)
        found[name] = np.ravel(means)[:COLUMNS].tolist()
    return found


def leaves(values: dict[str, Any], path: str = "summary") -> Any:
    """Yield the numbers in a summary with their paths."""
    for name, value in values.items():
        if isinstance(value, dict):
            yield from leaves(value, f"{path}.{name}")
        elif isinstance(value, int | float) and name not in OF_THE_MACHINE:
            yield f"{path}.{name}", [float(value)]


@pytest.mark.parametrize("game", GAMES)
def test_games_turn_out_as_under_this_version(game: str) -> None:
    stored = json.loads(STORED.read_text())
    assert stored["version"] == RESULTS
    found, expected = play(game), stored[game]
    assert found.keys() == expected.keys()
    for name, values in expected.items():
        assert found[name] == pytest.approx(values, rel=1e-4, abs=1e-6), name


@pytest.mark.parametrize("game", STUDIES)
def test_studies_turn_out_as_under_this_version(
    game: str, tmp_path: Path
) -> None:
    value, grid, expected = STUDIES[game]
    file = tmp_path / "study.toml"
    file.write_text(f'game = "{game}"\n[grid]\n{grid}\n')
    run = run_study(load_study(file))
    found = [record[value] for record in run.records()]
    assert found == pytest.approx(expected, rel=1e-4)


if __name__ == "__main__":
    stored: dict[str, Any] = {"version": RESULTS}
    for game in GAMES:
        stored[game] = {
            name: [float(f"{value:.7g}") for value in values]
            for name, values in play(game).items()
        }
    lines = (f'"{k}": {json.dumps(v)}' for k, v in stored.items())
    STORED.write_text("{\n" + ",\n".join(lines) + "\n}\n")
