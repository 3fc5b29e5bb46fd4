"""A robot on a walking policy that was made for the test."""

import tomllib
from math import hypot, sqrt
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("onnxruntime")
pytest.importorskip("onnx")

from flows.calls import (  # noqa: E402
    duel_on_legs,
    evade_person_on_legs,
    inspect_legs,
    load_run,
    measure_legs,
)
from imitated_walk import SPEED, TURN, nao_on_imitated_walk  # noqa: E402
from small_policies import JOINTS, METADATA, constant_policy  # noqa: E402

LATERAL = 0.05  # greatest lateral command, in [m/s]
TEMPLATE = 0.05  # speed of the template, in [m/s]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """NAO on a network that imitates our walk, and its measured response."""
    made = tmp_path_factory.mktemp("legs") / "nao"
    return nao_on_imitated_walk(made, LATERAL, period=0.02)


@pytest.fixture(scope="module")
def measured(folder: Path) -> Any:
    return measure_legs(folder)


CONTRACT: Any = METADATA


def test_inspect_tells_where_each_value_is_from(tmp_path: Path) -> None:
    network = constant_policy(tmp_path / "a.onnx")
    facts = inspect_legs(network, status=2)  # no posture of these joints
    contract = facts["contract"]
    sources = facts["sources"]
    assert facts["convention"] == "holosoma"
    assert contract["joints"] == list(JOINTS)
    assert contract["stiffness"] == METADATA["kp"]
    assert sources["stiffness"] == "metadata kp"
    assert contract["damping"] == METADATA["kd"]
    ranges = CONTRACT["command_ranges"]
    assert contract["command_ranges"]["forward"] == ranges["lin_vel_x"]
    assert contract["command_ranges"]["turn"] == ranges["ang_vel_yaw"]
    (finding,) = facts["findings"]
    assert finding == {
        "severity": "error",
        "text": "default_posture is missing",
    }


def test_inspect_passes_a_network_that_fits_its_robot(folder: Path) -> None:
    facts = inspect_legs(folder / "policy.onnx", robot=folder)
    contract = facts["contract"]
    assert facts["findings"] == []
    assert contract["command_ranges"]["forward"] == [-SPEED, SPEED]
    assert contract["command_ranges"]["lateral"] == [-LATERAL, LATERAL]
    assert contract["command_ranges"]["turn"] == [-TURN, TURN]
    assert len(contract["joints"]) == 11  # one yaw for both hips


def test_measure_finds_what_the_legs_deliver(
    folder: Path, measured: Any
) -> None:
    """The network was made from walks of these speeds."""
    (file,) = folder.glob("legs-*.toml")
    response = tomllib.loads(file.read_text(encoding="utf-8"))
    assert measured["falls"] == 0 and 0.0 < response["tube"] < 0.1
    for axis, column, exact in (("forward", 0, 0.06), ("turn", 2, 0.18)):
        commands = np.array(response[axis]["commands"])
        delivered = np.array(response[axis]["delivered"])[:, column]
        small = np.abs(commands) < exact
        assert small.sum() >= 5
        np.testing.assert_allclose(
            delivered[small], commands[small], atol=0.08 * exact
        )
        assert 0.0 < response[axis]["lag"] < 2.0
    commands = np.array(response["lateral"]["commands"])
    delivered = np.array(response["lateral"]["delivered"])[:, 1]
    np.testing.assert_allclose(delivered, commands, atol=0.02)


def test_legs_walk_as_fast_as_the_template(
    folder: Path, measured: Any, tmp_path: Path
) -> None:
    run = load_run(duel_on_legs(folder, tmp_path / "run", TEMPLATE, 12.0))
    for player, sign in (("pursuer", 1.0), ("evader", -1.0)):
        late = run.times > 5.0
        path, times = run.tracks[player].torso[late], run.times[late]
        ahead = np.stack([np.cos(path[:, 2]), np.sin(path[:, 2])], axis=1)
        way = (np.diff(path[:, :2], axis=0) * ahead[1:]).sum()
        speed = way / (times[-1] - times[0])
        assert speed == pytest.approx(sign * TEMPLATE, rel=0.1), player


def test_a_robot_on_legs_steps_out_of_the_way_of_a_person(
    folder: Path, measured: Any, tmp_path: Path
) -> None:
    """At 1.4 m/s it passes on one side; the robot begins and goes away."""
    runs = {}
    for strategy in ("step-aside", "stand"):
        run = evade_person_on_legs(
            folder, tmp_path / strategy, strategy, speed=1.4, miss=0.5
        )
        runs[strategy] = load_run(run)
    miss, speed = 0.5, 1.4
    aside, stood = runs["step-aside"], runs["stand"]
    # It begins 1.8 s before the person is within 0.8 m.
    ahead = sqrt(0.8**2 - miss**2) + 1.8 * speed
    began = aside.summary.triggered_at_distance_m
    assert began == pytest.approx(hypot(ahead, miss), abs=0.2)
    assert stood.summary.min_distance_m == pytest.approx(miss, abs=0.03)
    assert aside.summary.min_distance_m > miss + 0.05
    first, *_, last = aside.tracks["evader"].torso
    assert (last - first)[1] < -0.03  # the person passes at positive y
