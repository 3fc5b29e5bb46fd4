"""Test that a check says shares in percent, lengths and angles as named."""

from concurrent.futures import Executor, Future
from dataclasses import replace
from math import degrees, pi
from typing import Any

import pytest

from stepaside.fitting import (
    robot_verification as checking,
)
from stepaside.fitting import (
    walk_trials as trials,
)
from stepaside.fitting.gait_feasibility import step_loads
from stepaside.fitting.joint_strain import JointStrain
from stepaside.fitting.requirements import check_requirements
from stepaside.fitting.robot_verification import check_robot
from stepaside.fitting.walk_trials import (
    GREATEST_COM_ERROR,
    PATHS,
    WalkTrial,
    WalkTrialResult,
    trials_of,
    walk_trial,
)
from stepaside.games.robot_settings import settings_from_description
from stepaside.robots.description import load_robot

NAO = load_robot("nao")


class Here(Executor):
    """Does work at once, in this process."""

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Do it."""
        future: Future[Any] = Future()
        future.set_result(fn(*args, **kwargs))
        return future


def walked(trial: WalkTrial, **changes: Any) -> WalkTrialResult:
    """A steady walk whose joints bore something."""
    strain = JointStrain(0.37, "LHipRoll", 0.82, "RKneePitch", 0.0, 0.0043)
    plain = WalkTrialResult(
        trial.path.name,
        bool(trial.control.feedback),
        "walked",
        True,
        1.0,
        *(2.0, 0.01, 1.0, None, strain),
    )
    return plain._replace(**changes)


def test_torques_are_reported_in_percent_and_sag_in_mm(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(checking, "walk_trial", walked)
    found = check_robot(NAO, Here())
    said = {each.name: each.value for each in found.findings}
    assert said["torque, standing"] == "37 % of the limit of LHipRoll"
    assert said["torque, walking"] == "82 % of the limit of RKneePitch"
    assert said["sag"] == "4.3 mm"
    assert found.passes
    model = NAO.compile()
    torques = {
        model.joint(model.actuator_trnid[i, 0]).name: float(high)
        for i, high in enumerate(model.actuator_forcerange[:, 1])
    }
    borne = step_loads(NAO, settings_from_description(NAO).gait, torques)
    percent = f"{100.0 * borne.usual:.0f} % of the limit of {borne.joint}"
    assert said["torque of a step"] == percent
    assert 0.01 < borne.usual < 1.0
    assert f"{float(model.body_mass.sum()):.2f} kg" in said["masses"]


def test_percentages_are_between_0_and_100() -> None:
    """Whatever has a percent sign is between 1 and 100 for a sound robot."""
    for finding in check_requirements(NAO):
        words = finding.value.split()
        for number, unit in zip(words, words[1:], strict=False):
            if unit.startswith("%"):
                assert 0.0 <= float(number) <= 100.0
        assert finding.verdict == "pass", finding


def test_trial_paths_turn_to_the_side_of_their_name() -> None:
    for way in PATHS:
        assert abs(way.bearing) <= pi
        side = ("left" in way.name) - ("right" in way.name)
        assert (way.bearing > 0) - (way.bearing < 0) == side
        assert way.backward == ("backward" in way.name)
    turns = sorted(abs(way.bearing) for way in PATHS if way.bearing)
    assert turns == pytest.approx([pi / 4, pi / 2, pi / 2])
    for feedback in (False, True):
        for trial, way in zip(
            trials_of(NAO, feedback=feedback), PATHS, strict=True
        ):
            assert trial.path is way
            assert trial.control.feedback == feedback


@pytest.mark.parametrize("way", [PATHS[0], PATHS[3]], ids=["ahead", "turn"])
def test_a_walk_trial_reports_degrees_and_fractions(
    monkeypatch: pytest.MonkeyPatch, way: trials.TrialPath
) -> None:
    monkeypatch.setattr(trials, "CYCLES", 3)
    own = settings_from_description(NAO)
    leaning = replace(NAO, lean=0.03)
    found = walk_trial(WalkTrial(leaning, own.gait, own.control, way))
    assert found.completed and found.lasted == pytest.approx(1.0, abs=0.01)
    assert found.lean == pytest.approx(degrees(0.03))
    # It leans over a foot that the CoM is right over, so hardly so far.
    assert found.tilt is not None
    assert 0.3 * found.lean < found.tilt < 2.0 * found.lean
    assert found.strays is not None and found.strays < 2.0 * GREATEST_COM_ERROR
    assert found.speed is not None
    assert found.speed == pytest.approx(1.0, abs=0.3)
    if way.bearing:
        assert found.turning == pytest.approx(1.0, abs=0.3)
    assert found.strain is not None
    assert 0.0 < found.strain.standing <= found.strain.walking <= 1.0
    assert abs(found.strain.sag) < 0.02
    plain = found._replace(tilt=8.0 + found.lean, strays=0.0, speed=1.0)
    worst = plain._replace(turning=None).unsteadiness
    assert worst == pytest.approx(1.0)
