"""Test the commands circle, unicycles and map."""

import json
import time
from math import pi
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from stepaside.commands.circle import circle
from stepaside.commands.map import map as map_command
from stepaside.commands.unicycles import unicycles

COMPARED = (
    "radius_m",
    "radius_evader_m",
    "distance_m",
    "turning_rate_rad_s",
    "headings_apart_rad",
    "motions_apart_rad",
)
MAP = "--speed 0.1 --gain 0.2 --nearest 0.8 --farthest 1.5 --aim 30deg "
MAP += "--facing 30deg --grid 5 --distances 2 --step 0.1 --duration 60"


def run(command: Any, words: str) -> Result:
    return CliRunner().invoke(command, words.split())


def loads(command: Any, words: str) -> dict[str, Any]:
    result = run(command, words + " --json")
    assert result.exit_code == 0, result.output
    found: dict[str, Any] = json.loads(result.stdout)
    return found


def test_circle_prints_the_figures_of_figure_2() -> None:
    found = loads(circle, "--speed 1 --gain 0.5 --angle 90deg")
    assert found["radius_m"] == pytest.approx(8 / pi)
    assert found["distance_m"] == pytest.approx(3.6012652646)
    assert found["eigenvalues_per_s"][-1] == pytest.approx([-0.5, 0.0])
    assert found["stable"] and found["time_constant_s"] == pytest.approx(4)
    assert 0 < found["largest_stable_delay_s"] < 10


def test_circle_that_does_not_exist_is_an_answer() -> None:
    found = loads(circle, "--strategy move-back")
    assert found["exists"] is False and found["radius_m"] is None
    table = run(circle, "--strategy move-back")
    assert table.exit_code == 0 and "no circle" in table.output


def test_sampling_and_delay_are_judged() -> None:
    words = "--speed 0.1 --gain 0.2 --sample-time 0.4 --delay 0.2"
    found = loads(circle, words)
    assert found["stable"]
    assert len(found["step_eigenvalues"]) == 5
    limit = found["largest_stable_sample_time_s"]
    late = loads(circle, f"--speed 0.1 --gain 0.2 --sample-time {limit + 0.1}")
    assert late["stable"] in (True, False)
    assert not loads(circle, "--delay 5")["stable"]


@pytest.mark.parametrize(
    "words",
    [
        "--speed 1 --gain 0.5",
        "--law saturated",
        "--law saturated --angle 0.3",
        "--angle 0.1",
        "--law saturated --angle 0.1",
        "--pursuer-speed 1.2 --evader-gain 0.8 --angle 70deg",
    ],
)
def test_simulation_reaches_the_closed_form_soon(words: str) -> None:
    start = time.monotonic()
    played = loads(unicycles, words)
    assert time.monotonic() - start < 5.0
    theory = loads(circle, words)
    for name in COMPARED:
        assert played[name] == pytest.approx(theory[name], abs=1e-3), name


def test_held_turning_rates_reach_it_too() -> None:
    words = "--speed 0.1 --gain 0.2 --sample-time 0.4 --delay 0.3"
    played = loads(unicycles, words)
    for name in COMPARED:
        assert played[name] == pytest.approx(played["theory"][name], abs=1e-3)


def test_figures_are_written(tmp_path: Path) -> None:
    for command, words, name in [
        (unicycles, "--figure", "game.png"),
        (circle, "--sweep", "sweep.svg"),
        (map_command, f"{MAP} --figure", "map.png"),
    ]:
        result = run(command, f"{words} {tmp_path / name}")
        assert result.exit_code == 0, result.output
        assert (tmp_path / name).stat().st_size > 10_000


def test_map_names_the_worst_start() -> None:
    found = loads(map_command, MAP)
    assert found["games"] == 50
    assert found["captured_share"] == 0.0
    low = found["min_distance_m"]
    assert 0.4 < low <= found["mean_closest_distance_m"]
    start = found["worst_start"]
    words = (
        f"--speed 0.1 --gain 0.2 --duration 60 --distance "
        f"{start['distance_m']} --aim {start['pursuer_error_rad']} "
        f"--bearing {start['bearing_rad']}"
    )
    again = loads(unicycles, words)
    assert again["closest_distance_m"] == pytest.approx(low, abs=1e-6)


@pytest.mark.parametrize("command", [circle, unicycles, map_command])
@pytest.mark.parametrize(
    ("words", "got"),
    [
        ("--speed 0", "'0'"),
        ("--gain nan", "'nan'"),
        ("--angle 200deg", "3.49"),
        ("--angle north", "'north'"),
        ("--law hard", "'hard'"),
        ("--hysteresis 2", "2.0"),
        ("--angle 1 --strategy move-back", "not both"),
    ],
)
def test_bad_input_is_one_line_and_status_2(
    command: Any, words: str, got: str
) -> None:
    result = run(command, words + " --json")
    assert result.exit_code == 2
    assert result.stdout == ""
    assert got in result.stderr.splitlines()[-1]


def test_figure_that_cannot_be_written_is_refused_first(
    tmp_path: Path,
) -> None:
    for name in ("game.txt", "nowhere/game.png"):
        result = run(unicycles, f"--figure {tmp_path / name}")
        assert result.exit_code == 2 and "--figure" in result.stderr
    assert not list(tmp_path.iterdir())
