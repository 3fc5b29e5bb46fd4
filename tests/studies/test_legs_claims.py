"""Test the claims about the paper's game on learned legs."""

from dataclasses import replace
from math import isnan, pi
from pathlib import Path

import pytest

pytest.importorskip("onnxruntime")
pytest.importorskip("onnx")

from legs_robot import nao_on_legs
from stepaside.cli.main import main
from stepaside.core.errors import ConfigurationError
from stepaside.sim.push import Push
from stepaside.studies.claim_campaign import (
    claim_study,
    jobs_of,
)
from stepaside.studies.claim_jobs import JOBS
from stepaside.studies.legs_claims import (
    CLAIMS,
    NAME,
    learned_legs_job,
    legs_settings,
    measure_circle,
)
from stepaside.theory.unicycle.circle_equations import find_circle


def test_the_claims_are_those_of_theory_at_this_speed_and_gain() -> None:
    circle = find_circle(0.5, 0.5, 0.4, 0.4, pi / 2, "proportional")
    expected = {claim.key: claim.expected for claim in CLAIMS}
    assert expected["pursuer_radius"] == pytest.approx(circle.radius_pursuer_m)
    assert expected["evader_radius"] == pytest.approx(circle.radius_evader_m)
    assert expected["distance"] == pytest.approx(circle.distance_m)


def test_they_are_measured_only_on_a_robot_with_a_policy(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert jobs_of() == JOBS
    with pytest.raises(ConfigurationError, match="must have learned legs"):
        jobs_of("nao")
    with pytest.raises(SystemExit) as left:
        output = f"--output={tmp_path / 'report'}"
        main(["reproduce", "--legs-robot", "nao", output])
    assert left.value.code == 2
    assert "names no network in [locomotion]" in capsys.readouterr().err


def test_another_network_is_measured_anew(tmp_path: Path) -> None:
    folder = str(nao_on_legs(tmp_path / "nao"))
    job = learned_legs_job(folder)
    texts = [job.settings(seed) for seed in (1, 2)]
    assert texts[0] != texts[1]
    nao_on_legs(tmp_path / "other", gain=0.1)
    other = tmp_path / "other" / "policy.onnx"
    Path(folder, "policy.onnx").write_bytes(other.read_bytes())
    assert job.settings(1) != texts[0]


def test_a_duel_that_reaches_no_circle_confirms_nothing(
    tmp_path: Path,
) -> None:
    folder = str(nao_on_legs(tmp_path / "nao"))
    values = measure_circle(legs_settings(folder, 1, duration=0.5))
    assert values.keys() == {claim.key for claim in CLAIMS}
    assert not any(claim.holds([values[claim.key]]) for claim in CLAIMS)
    pushed = replace(
        legs_settings(folder, 1, duration=4.0),
        pushes=(Push(20.0, 1.1, 0.0),),
    )  # it falls
    assert all(isnan(value) for value in measure_circle(pushed).values())


def test_the_study_has_a_run_for_each_seed(tmp_path: Path) -> None:
    folder = str(nao_on_legs(tmp_path / "nao"))
    study = claim_study(range(1, 4), folder)
    trials = [trial for trial in study.cases if trial.job == NAME]
    assert [trial.seed for trial in trials] == [1, 2, 3]
    assert {trial.legs for trial in trials} == {folder}
    assert not any(trial.legs for trial in study.cases if trial.job != NAME)
