"""Test the command line: JSON, run folders, refusals."""

import json
import tomllib
from concurrent.futures import BrokenExecutor
from math import inf
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result

from stepaside.cli.main import COMMANDS, main
from stepaside.core.errors import PlanError
from stepaside.fitting.robot_verification import (
    RequirementCheck,
    VerificationReport,
)
from stepaside.strategies.body_departure import BodyDeparture

pytestmark = pytest.mark.usefixtures("blank_figures")
STORED = "locomotion.departures.store_departure"


def run(*arguments: str) -> Result:
    return CliRunner().invoke(main, arguments)


def run_json(*arguments: str) -> Any:
    result = run(*arguments, "--json")
    assert result.exit_code == 0, result.stderr
    return json.loads(result.stdout)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help(command: str) -> None:
    result = run(command, "--help")
    assert result.exit_code == 0
    assert "Usage" in result.stdout


def test_plan_dcm_is_the_quadrature_of_its_zmp_pieces() -> None:
    """Eq. (16), from what the command prints alone."""
    plan = run_json("theory", "plan", "--role", "evader", "--bearing", "-2.2")
    eta = plan["eta_per_s"]
    durations = np.array(plan["zmp_pieces"]["durations_s"])
    coefficients = np.array(plan["zmp_pieces"]["coefficients"])
    starts = np.concatenate([[0.0], np.cumsum(durations)])
    nodes, weights = np.polynomial.legendre.leggauss(20)
    for index in (0, 77, 300, 1000):
        now = plan["times_s"][index]
        total = np.zeros(2)
        for piece, (start, lasts) in enumerate(
            zip(starts[:-1], durations, strict=True)
        ):
            low, high = max(now, start), start + lasts
            if high <= now:
                continue
            t = 0.5 * (high - low) * nodes + 0.5 * (high + low)
            w = 0.5 * (high - low) * weights * eta * np.exp(-eta * (t - now))
            powers = (t - start) ** np.arange(4)[:, None]
            total += (powers.T @ coefficients[:, piece] * w[:, None]).sum(0)
        rest = durations[-1] ** np.arange(4) @ coefficients[:, -1]
        total += rest * np.exp(-eta * (starts[-1] - now))
        np.testing.assert_allclose(plan["dcm"][index], total, atol=1e-9)


def test_duel_writes_a_run_folder_that_repeats_it(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    options = ("--duration", "4", "--seed", "9", "--output", str(folder))
    first = run_json("duel", *options)
    assert first["outcome"] == "completed"
    assert first["seed"] == 9
    assert {file.name for file in folder.iterdir()} == {
        "checksums.txt",
        "configuration.toml",
        "summary.json",
        "trajectories.npz",
        "duel.png",
    }
    configuration = folder / "configuration.toml"
    assert tomllib.loads(configuration.read_text())["seed"] == 9
    again = run_json("duel", "--config", str(configuration))
    for name in ("planning", "real_time_factor", "run_folder"):
        first.pop(name)
        again.pop(name, None)
    assert first == again
    arrays = np.load(folder / "trajectories.npz")
    assert arrays["pursuer_com"].shape == (len(arrays["times_s"]), 3)


ERRORS = [
    (PlanError("speed must"), 2, "stepaside: speed must"),
    (ModuleNotFoundError("", name="daqp"), 2, "stepaside[mpc]"),
    (OSError(13, "Permission denied", "a.toml"), 2, "a.toml: permission"),
    (OSError("broken pipe of links"), 2, "stepaside: broken pipe of links"),
    (BrokenExecutor(), 2, "a worker process was killed"),
    (KeyboardInterrupt(), 130, "interrupted; half-written"),
]


@pytest.mark.parametrize(("error", "status", "words"), ERRORS)
def test_each_expected_error_is_one_line_with_its_status(
    error: BaseException, status: int, words: str
) -> None:
    def fail(*_: Any, **__: Any) -> None:
        raise error

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("click.Group.main", fail)
        result = run("doctor")
    (line,) = result.stderr.strip().splitlines()
    assert words in line and result.exit_code == status and not result.stdout


def test_interrupted_duel_reports_its_run(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    from stepaside.games.recorded_game import RecordedGame

    tick = RecordedGame.tick

    def impatient(self: RecordedGame, until: float = inf) -> Any:
        if self.in_physics.ticks >= 300:
            raise KeyboardInterrupt
        return tick(self, until)

    monkeypatch.setattr(RecordedGame, "tick", impatient)
    folder = tmp_path / "run"
    result = run("duel", "--seed", "2", "--output", str(folder))
    assert result.exit_code == 130
    assert "interrupted at 1.20 s" in result.stdout
    assert (folder / "trajectories.npz").exists()
    # No figure is drawn after Ctrl-C.
    assert not list(folder.glob("*.png")) and "figure:" not in result.stdout
    assert f"the run so far is saved in {folder}" in result.stderr


def test_zero_is_a_given_value() -> None:
    """Seed 0 and evasion angle 0 differ from missing options."""
    found = run_json(
        "duel", "--seed", "0", "--set", "evasion.angle=0", "--duration", "0.2"
    )
    assert found["seed"] == 0
    assert found["theory"]["radius_m"] is None


def test_a_check_prints_the_departure_of_the_body(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found = RequirementCheck("masses", "pass", "5 kg", "weigh it")
    report = VerificationReport([found], [], False, BodyDeparture(*[0.25] * 4))
    for name in ("fitting.robot_verification.check_robot", STORED):
        monkeypatch.setattr(f"stepaside.{name}", lambda *_: report)
    told = run("robot", "check", "nao").stdout
    assert "tube   0.2500 m" in told and "masses: weigh it" in told
