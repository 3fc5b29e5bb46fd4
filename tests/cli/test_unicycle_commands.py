"""Test the commands circle, unicycles and map."""

import json
from typing import Any

import pytest
from click.testing import CliRunner, Result

from stepaside.cli.main import main
from stepaside.cli.run import unicycles
from stepaside.cli.theory import circle
from stepaside.cli.theory import map as map_command

COMPARED = (
    "radius_pursuer_m",
    "radius_evader_m",
    "distance_m",
    "turning_rate_rad_s",
    "headings_apart_rad",
    "motions_apart_rad",
)
MAP = "--speed 0.1 --gain 0.2 --nearest 0.8 --farthest 1.5 --set aim=30deg "
MAP += "--set facing=30deg --grid 5 --set distances=2 "
MAP += "--set duration=60"


def run(command: Any, words: str) -> Result:
    group = "run" if command is unicycles else "theory"
    return CliRunner().invoke(main, [group, command.name, *words.split()])


def loads(command: Any, words: str) -> dict[str, Any]:
    result = run(command, words + " --json")
    assert result.exit_code == 0, result.output
    found: dict[str, Any] = json.loads(result.stdout)
    return found


def test_simulation_reaches_the_closed_form() -> None:
    words = "--set pursuer_speed=1.2 --set evader_gain=0.8 --angle 70deg"
    played = loads(unicycles, words)
    assert played["circle"]["direction"] == 1
    theory = loads(circle, words)
    for name in COMPARED:
        assert played[name] == pytest.approx(theory[name], abs=1e-3), name


def test_a_game_ends_at_the_capture_distance() -> None:
    words = "--distance 1 --set evader_speed=0.01 --set capture="
    for capture in (0.2, 0.4):
        found = loads(unicycles, f"{words}{capture}")
        assert found["captured"]
        assert found["closest_distance_m"] == pytest.approx(capture, abs=1e-6)


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
