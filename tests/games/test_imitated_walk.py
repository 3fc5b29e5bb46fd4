"""Test robots on a policy that walks, made from our own walk."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("onnxruntime")
pytest.importorskip("onnx")

from imitated_walk import nao_on_imitated_walk
from stepaside.control.sensor_sight import CameraSight
from stepaside.core.poses import Pose
from stepaside.games.game import Outcome
from stepaside.games.game_settings import duel as make_duel
from stepaside.games.game_settings import read_game
from stepaside.games.players import RobotPlayer
from stepaside.games.recorded_game import RecordedGame, run_game
from stepaside.sim.camera_settings import CameraSettings, ColourSettings
from stepaside.sim.person_settings import PersonSettings


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return nao_on_imitated_walk(tmp_path_factory.mktemp("imitated") / "nao")


@pytest.mark.slow
def test_two_robots_pursue_and_evade_on_policies(folder: Path) -> None:
    settings = read_game(
        {"robot": str(folder)}, base=make_duel(duration=12.0, seed=3)
    )
    gait = replace(settings.gait, speed=0.06, gain=0.2)
    start = replace(settings.start, distance=0.75)
    run = run_game(settings.changed(gait=gait, start=start))
    assert run.outcome is Outcome.COMPLETED
    for track in run.tracks.values():
        paths = np.hypot(*np.diff(track.torso[:, :2], axis=0).T).sum()
        assert paths > 0.4
    evader = run.tracks["evader"].torso
    ahead = np.array([np.cos(evader[0, 2]), np.sin(evader[0, 2])])
    assert (evader[-1, :2] - evader[0, :2]) @ ahead < -0.2  # backward


def test_cameras_on_learned_legs_are_where_the_loaded_foot_puts_them(
    folder: Path,
) -> None:
    """Their images show a person, whom the robot evades."""
    pytest.importorskip("cv2")
    settings = read_game(
        {"robot": str(folder)}, base=make_duel(duration=4.0, seed=3)
    )
    start = replace(
        settings.start, distance=2.6, pursuer_offset=0.0, evader_offset=0.0
    )
    settings = settings.changed(
        evader={"strategy": "evasion"},
        gait=replace(settings.gait, speed=0.06, gain=0.2),
        pursuer={"body": "person"},
        person=PersonSettings("straight", 0.5),
        evasion=replace(
            settings.evader.evasion, trigger="time", contact_time=4.0
        ),
        senses="cameras",
        cameras=CameraSettings(ColourSettings(renderer="raycast")),
        start=start,
    )
    duel = RecordedGame(settings, endless=True)
    evader = duel.in_physics.players[1]
    assert isinstance(evader, RobotPlayer)
    senses = evader.scheme.senses
    assert isinstance(senses, CameraSight)
    head = duel.in_physics.model.body("evader/head").id
    errors = []
    while duel.world.time < 4.0:
        true = duel.in_physics.data.xpos[head].copy()
        assert duel.tick() is None
        body = senses.perception.body
        assert body is not None
        x, y, z = body.position_head_in_odometry
        place = evader.frame.compose(Pose(x, y, 0.0))
        if duel.world.time > 1.2:  # attitude is calibrated
            errors.append(np.array([place.x, place.y, z]) - true)
    duel.world.close()
    assert np.abs(errors)[:, 2].max() < 0.01
    assert np.abs(errors).max() < 0.03
    assert evader.is_moving
    sighting = senses.perception.sighting
    assert sighting is not None
    assert sighting.distance == pytest.approx(duel.distance, abs=0.2)
