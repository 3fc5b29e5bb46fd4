"""Test that the results version is raised when games turn out otherwise.

Three seeds of each kind of game, or three settings of one without chance. A
change in the last bits is none; if a value changes by more, raise ``RESULTS``
and put the new values here.
"""

from pathlib import Path

import pytest

from stepaside.studies.results_version import RESULTS
from stepaside.studies.study import run_study
from stepaside.studies.study_design import load_study

VERSION = "2026.3"  # that the values below belong to
GAMES: dict[str, tuple[str, str, list[float]]] = {
    "duel": (
        "min_distance_m",
        "duration = 3.0\nstart.distance = 0.8",
        [0.718431413, 0.752657342, 0.751848599],
    ),
    "walk": (
        "walking.tilt_max_deg",
        "duration = 4.0",
        [0.140686227, 0.145794602, 0.145991668],
    ),
    "tournament": (
        "closest_m",
        "duration = 41.025\npursuers_pass = true\nroom.discs = 3",
        [0.747292303, 0.781406943, 0.46711146],
    ),
    "unicycles": (
        "distance_m",
        "duration = 20.0\nspeed = 0.1\ngain = 0.2\ndistance = 1.0\n"
        "bearing = 0.0",
        [0.777901202, 0.834319326, 1.16095572],
    ),
}
"""Value, settings and the three values of each kind of game.

The floor of the walk is even: an uneven one makes 10 % of the last bits.
"""


@pytest.mark.parametrize("game", GAMES)
def test_games_turn_out_as_under_this_version(
    game: str, tmp_path: Path
) -> None:
    value, settings, expected = GAMES[game]
    file = tmp_path / "study.toml"
    seeds = {
        "unicycles": "aim = [0.1, 0.5, 2.0]",
        "walk": "walker.strategy = ['walk(bearing=0.0)', "
        "'walk(bearing=0.3)', 'walk(bearing=-1.0)']",
    }.get(game, 'seed = "1:4"')
    file.write_text(
        f'game = "{game}"\n[grid]\n{seeds}\n[settings]\n{settings}\n'
    )
    run = run_study(load_study(file))
    found = [record[value] for record in run.records()]
    assert RESULTS == VERSION
    assert found == pytest.approx(expected, rel=1e-4)
