"""Test published networks, where the wheels that contain them are installed.

``pip install --no-deps holosoma-inference example-robot-data`` brings them.
"""

import sysconfig
from dataclasses import replace
from importlib.util import find_spec
from math import pi
from pathlib import Path

import pytest

pytest.importorskip("onnxruntime")

from stepaside.cli.main import main
from stepaside.fitting.legs_measurement import LegsTrial, run_trial
from stepaside.games.game import Outcome
from stepaside.games.game_settings import duel, read_game
from stepaside.games.recorded_game import run_game
from stepaside.locomotion.control_settings import LegsSettings
from stepaside.locomotion.policy.contract_reader import read_contract
from stepaside.locomotion.policy.runner import PolicyNetwork
from stepaside.robots.description import load_robot
from stepaside.sim.body_settings import BodySettings
from stepaside.sim.person_settings import PersonSettings
from stepaside.strategies.velocity_set import BodyVelocity

G1 = (
    Path(sysconfig.get_path("purelib"))
    / "cmeel.prefix/share/example-robot-data/robots/g1_description"
)


def network_of(robot: str, kind: str) -> Path:
    wheel = find_spec("holosoma_inference")
    if wheel is None or not wheel.submodule_search_locations:
        pytest.skip("holosoma-inference is not installed")
    folder = Path(wheel.submodule_search_locations[0]) / "models" / "loco"
    return folder / robot / f"{kind}_{robot}.onnx"


@pytest.mark.parametrize("kind", ["fastsac", "ppo"])
@pytest.mark.parametrize("robot", ["g1_29dof", "t1_29dof"])
def test_metadata_and_convention_complete_the_contract(
    robot: str, kind: str
) -> None:
    network = PolicyNetwork(network_of(robot, kind))
    contract = read_contract(network).check()
    assert contract.convention == "holosoma"
    assert len(contract.joints) == 29
    assert any(angle != 0.0 for angle in contract.default_posture)


@pytest.fixture(scope="module")
def g1(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Description of the G1."""
    if not G1.is_dir():
        pytest.skip("example-robot-data is not installed")
    folder = tmp_path_factory.mktemp("robots") / "g1"
    model = G1 / "urdf" / "g1_29dof_rev_1_0.urdf"
    arguments = [str(model), f"--meshes={G1 / 'meshes'}"]
    with pytest.raises(SystemExit) as left:
        main(["robot", "init", *arguments, f"--output={folder}"])
    assert left.value.code in (0, None)
    return folder


def test_a_published_network_gets_out_of_the_way_of_a_person(g1: Path) -> None:
    """At 1.4 m/s from the left, aimed at its centre."""
    network = str(network_of("g1_29dof", "fastsac"))
    settings = read_game(
        {"robot": str(g1), "legs": {"network": network}}, base=duel()
    )
    settings = settings.changed(
        pursuer={"body": "person"},
        person=PersonSettings("straight", 1.4),
        evader={"strategy": "step-aside"},
        start=replace(
            settings.start,
            distance=6.0,
            pursuer_offset=0.0,
            evader_offset=-0.5 * pi,
        ),
        duration=6.0,
    )
    run = run_game(settings)
    assert run.outcome is Outcome.COMPLETED
    closest = run.summary.min_distance_m
    assert closest is not None and closest > 0.9


def test_a_published_network_walks_a_published_robot(g1: Path) -> None:
    """At 0.4 m/s of 0.5 commanded."""
    network = network_of("g1_29dof", "fastsac")
    trial = LegsTrial(
        load_robot(g1),
        LegsSettings(str(network)),
        BodySettings(),
        1,
        BodyVelocity(0.5, 0.0, 0.0),
    )
    result = run_trial(trial)
    assert result.fell_at is None
    assert 0.35 < result.delivered.forward < 0.5
    assert abs(result.delivered.lateral) < 0.1
