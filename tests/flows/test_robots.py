"""A humanoid that stepaside has never seen, from its published model."""

import tomllib
from math import sqrt
from pathlib import Path
from typing import Any

import pytest

import vendor_humanoid as vendor
from flows.calls import check_robot, describe_robot, duel_of_robot, tune_robot

GRAVITY = 9.81  # [m/s^2]
LEG_JOINTS = [name for name, *_ in vendor.LEG]
MASS = 12.0 + 2.0 * sum(part[-1] for part in vendor.LEG)


@pytest.fixture(scope="module")
def models(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("models")
    return {"mjcf": vendor.mjcf(folder), "urdf": vendor.urdf(folder)}


@pytest.fixture(scope="module")
def folder(models: dict[str, Path]) -> Path:
    """Description that was derived from the MJCF."""
    found = models["mjcf"].with_name("own")
    describe_robot(models["mjcf"], found)
    return found


@pytest.mark.parametrize("kind", ["mjcf", "urdf"])
def test_init_reads_a_model(
    kind: str, models: dict[str, Path], tmp_path: Path
) -> None:
    facts = describe_robot(models[kind], tmp_path / "own")
    assert facts["mass_kg"] == pytest.approx(MASS, rel=1e-4)
    assert facts["hip_width_m"] == pytest.approx(vendor.WIDTH)
    back, front, half = vendor.SOLE
    sole = {"back": back, "front": front, "outer": half, "inner": half}
    assert facts["sole_m"] == pytest.approx(sole)
    assert facts["legs"] == [
        [f"{side}_{joint}" for joint in LEG_JOINTS] for side in ("near", "far")
    ]
    lowest, highest = facts["com_heights_m"]
    height = facts["com_height_m"]
    assert lowest < height < highest
    # NAO's gait, scaled by the height of the CoM.
    gait, second = facts["gait"], sqrt(height / GRAVITY)
    assert gait["stride"] == pytest.approx(0.15 * height, rel=0.01)
    assert gait["single_support"] == pytest.approx(2.0 * second, rel=0.01)
    assert gait["foot_spacing"] == pytest.approx(vendor.WIDTH)
    text = (tmp_path / "own" / "robot.toml").read_text(encoding="utf-8")
    own = tomllib.loads(text)
    assert own["gait"] == gait and own["torso"] == "chest"
    # A push of one unit gives as much of the pendulum's speed as for NAO.
    push = 0.12 * MASS * sqrt(GRAVITY * height)
    assert own["game"]["push_unit"] == pytest.approx(push, rel=0.01)
    for joint, servo in own["overlay"]["servos"].items():
        assert servo["torque"] == vendor.TORQUE, joint
    # The MJCF has no speed limits, and says where to fill them in.
    missing = len(facts["missing_values"]["speed_limits"])
    assert missing == (12 if kind == "mjcf" else 0)
    assert ("# ASK" in text) == bool(missing)
    speeds = set(own["speed_limits"].values())
    assert kind == "mjcf" or speeds == {9.5}


def test_check_passes_a_robot_that_walks(folder: Path) -> None:
    report = check_robot(folder)
    assert report["passes"]
    verdicts = {f["name"]: f["verdict"] for f in report["findings"]}
    assert verdicts["walks open loop"] == "pass"
    assert verdicts["walks with feedback"] == "pass"
    assert len(report["walks"]) == 10
    for walk in report["walks"]:
        assert walk["completed"]
        assert walk["speed"] == pytest.approx(1.0, abs=0.05), walk["way"]
        if walk["turning"] is not None:
            assert walk["turning"] == pytest.approx(1.0, abs=0.05)


def changed(folder: Path, new: Path, **gait: float) -> Path:
    """Copy a description beside its model, with other values."""
    new.mkdir()
    lines = (folder / "robot.toml").read_text(encoding="utf-8").splitlines()
    for i, line in enumerate(lines):
        for key, value in gait.items():
            if line.startswith(f"{key} ="):
                lines[i] = f"{key} = {value}"
    text = "\n".join([*lines, ""])
    (new / "robot.toml").write_text(text, encoding="utf-8")
    return new


def test_check_names_what_legs_cannot_reach(folder: Path) -> None:
    tall = changed(folder, folder.with_name("tall"), com_height=0.9)
    report = check_robot(tall, status=1)
    failed = {
        f["name"]: f for f in report["findings"] if f["verdict"] == "fail"
    }
    assert set(failed) == {"reach"} and failed["reach"]["hint"]


def test_tune_finds_and_writes_a_steadier_gait(folder: Path) -> None:
    """Steps that are too quick get longer, both supports alike."""
    quick = 0.25  # [s]
    hasty = changed(folder, folder.with_name("hasty"), single_support=quick)
    report = tune_robot(hasty)
    before, best = report["before"], report["best"]
    assert report["changed"] and before["unsteadiness"] > 1.0
    assert best["unsteadiness"] < 0.2 and len(best["walks"]) == 5
    for walk in best["walks"]:
        assert walk["completed"]
        assert walk["speed"] == pytest.approx(1.0, abs=0.05)
    text = (hasty / "robot.toml").read_text(encoding="utf-8")
    gait: Any = tomllib.loads(text)["gait"]
    assert gait == report["gait"]
    assert gait["single_support"] > quick
    own = tomllib.loads((folder / "robot.toml").read_text(encoding="utf-8"))
    factor = gait["single_support"] / quick
    assert gait["double_support"] == pytest.approx(
        factor * own["gait"]["double_support"], rel=1e-3
    )


def test_a_new_robot_ends_on_the_circle_of_its_gait(folder: Path) -> None:
    """The radius of (7): equal players circle at a quarter turn."""
    summary = duel_of_robot(folder, 1.8, duration=75.0)
    text = (folder / "robot.toml").read_text(encoding="utf-8")
    gait = tomllib.loads(text)["gait"]
    radius = gait["speed"] / gait["gain"] / (0.25 * 3.141592653589793)
    assert summary["outcome"] == "completed"
    assert summary["theory"]["radius_m"] == pytest.approx(radius, rel=1e-3)
    for player in ("pursuer", "evader"):
        assert summary["players"][player]["radius_m"] == pytest.approx(
            radius, rel=0.03
        )
    chord = sqrt(2.0) * radius
    assert summary["distance_m"] == pytest.approx(chord, rel=0.03)
    angle = summary["relative_orientation_deg"]
    assert angle == pytest.approx(90.0, abs=2.0)
