"""The command ``stepaside robustness``, with simulated walks replaced."""

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from inline_executor import InlineExecutor
from stepaside.cli.main import main
from stepaside.core import worker_pool as pools
from stepaside.studies import push_limits
from stepaside.studies import robustness_campaign as campaign
from stepaside.studies.result_files import read_result
from stepaside.studies.results_version import RESULTS
from stepaside.studies.robustness_trial import RobustnessTrial
from stepaside.studies.survival_statistics import push_bound_at

pytestmark = pytest.mark.usefixtures("blank_figures")

ASKED = "--kind backlash --kind push --method mpc --seeds 3 --phases 1".split()


def survive_a_newton_second(trial: RobustnessTrial) -> dict[str, Any]:
    """Every push up to 1 N s is survived, and every other disturbance."""
    return {"survived": trial.kind != "push" or trial.strength <= 1.0}


@pytest.fixture(autouse=True)
def no_walks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(campaign, "run_trial", survive_a_newton_second)
    monkeypatch.setattr(push_limits, "run_trial", survive_a_newton_second)
    monkeypatch.setattr(pools, "worker_pool", lambda _: InlineExecutor())


def run(*arguments: str) -> str:
    result = CliRunner().invoke(main, ["robustness", *arguments])
    assert result.exit_code == 0, result.output
    return result.stdout


def test_push_limits_are_printed_with_their_bound(tmp_path: Path) -> None:
    asked = ("--kind", "push", "--method", "mpc", "--phases", "2")
    printed = run(*asked, "--output", str(tmp_path))
    cells = " ".join(f"1.0/{push_bound_at('left', x):.1f}" for x in (0.0, 0.5))
    assert f"left      {cells}" in printed
    assert "0 of 8" in printed
    made = read_result(tmp_path / "pushes.json")
    assert len(made["rows"]) == 8 and made["summary"]["mpc"]["cases"] == 8
    assert {row["limit_n_s"] for row in made["rows"]} == {1.0}
    for name in ("limits.png", "survival.png"):
        assert (tmp_path / name).read_bytes()[:4] == b"\x89PNG"


def test_survival_result_names_its_version_and_settings(
    tmp_path: Path,
) -> None:
    run(*ASKED, "--seed", "4", "--output", str(tmp_path))
    made = read_result(tmp_path / "survival.json")
    assert made["results"] == RESULTS
    assert made["settings"] == {
        "kinds": ["backlash", "push"],
        "methods": ["mpc"],
        "body": "ideal",
        "phases": 1,
        "seeds": 3,
        "seed": 4,
    }
    assert {row["method"] for row in made["survival"]} == {"mpc"}


def test_other_disturbances_are_counted_over_seeds() -> None:
    answer = json.loads(
        run(
            *(
                "--kind",
                "backlash",
                "--method",
                "mpc",
                "--seeds",
                "3",
                "--json",
            )
        )
    )
    assert answer["limits"] == []
    assert {row["trials"] for row in answer["survival"]} == {3}
    assert answer["planned"] == {"trials": 15, "push_limits": 0}
    assert answer["done"] == {"trials": 15, "push_limits": 0, "push_walks": 0}


def test_repeated_kinds_are_planned_once() -> None:
    answer = json.loads(run(*ASKED, *ASKED, "--json"))
    assert answer["planned"] == {"trials": 15, "push_limits": 4}


def test_trials_and_push_limits_are_counted_separately() -> None:
    answer = json.loads(run(*ASKED, "--json"))
    assert answer["planned"] == {"trials": 15, "push_limits": 4}
    walks = 4 * len((0.4, 0.8, 1.2, 1.0, 1.1))
    assert answer["done"] == {
        "trials": 15,
        "push_limits": 4,
        "push_walks": walks,
    }


def test_interrupted_campaign_overwrites_no_result(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run(*ASKED, "--output", str(tmp_path))
    for file in tmp_path.glob("*.sqlite"):
        file.unlink()
    before = {f: f.read_bytes() for f in tmp_path.iterdir()}
    assert {f.name for f in before} > {"pushes.json", "survival.json"}
    left = iter(range(7))

    def stopped(trial: RobustnessTrial) -> dict[str, Any]:
        if next(left, None) is None:
            raise KeyboardInterrupt
        return survive_a_newton_second(trial)

    monkeypatch.setattr(campaign, "run_trial", stopped)
    asked = ("robustness", *ASKED, "--output", str(tmp_path))
    result = CliRunner().invoke(main, asked)
    assert result.exit_code == 130
    assert "7 of 15 trials and 0 of 4 push limits" in result.stderr
    assert f"are saved in {tmp_path}; run the same" in result.stderr
    assert before == {file: file.read_bytes() for file in before}


def test_help_explains_the_seeds_of_walks() -> None:
    text = " ".join(run("--help").split())
    assert (
        "Random seed of the first walk; later walks increment it. Pushes use "
        "this seed only. [default: 1" in text
    )


def test_gait_and_robot_are_part_of_the_trial_key(tmp_path: Path) -> None:
    """They share a folder: none is taken for the other."""
    asked = ("--kind", "push", "--method", "mpc", "--phases", "1")
    usual, low = (
        json.loads(run(*asked, *more, "--json"))
        for more in ((), ("--set", "gait.com_height=0.2"))
    )
    assert usual["limits"][0]["limit_n_s"] == low["limits"][0]["limit_n_s"]
    bounds = [found["limits"][0]["bound_n_s"] for found in (usual, low)]
    assert bounds[1] != pytest.approx(bounds[0], rel=1e-3)
    run(*asked, "--set", "gait.com_height=0.2", "--output", str(tmp_path))
    made = read_result(tmp_path / "survival.json")
    changes = json.loads(made["settings"]["changes"])
    assert changes == {"gait": {"com_height": 0.2}}
    pushes = read_result(tmp_path / "pushes.json")
    assert pushes["settings"]["gait"]["com_height"] == 0.2
    assert pushes["settings"]["robot"] == "nao"


def test_changed_body_is_called_own() -> None:
    asked = ("--kind", "backlash", "--method", "mpc", "--seeds", "1", "--json")
    own = json.loads(run(*asked, "--set", "body.stiffness=0.5"))
    assert own["body"] == "own"
    assert json.loads(run(*asked, "--body", "hardware"))["body"] == "hardware"


def test_legs_are_refused_without_people() -> None:
    result = CliRunner().invoke(
        main, ["robustness", "--kind", "push", "--legs", "walk.onnx"]
    )
    assert result.exit_code == 2
    assert "--kind person" in result.output
