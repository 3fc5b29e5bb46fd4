"""Test duels with camera sensing, rendered by ray casting."""

from dataclasses import replace
from math import atan2, degrees, hypot, radians

import numpy as np
import pytest

from stepaside.control.sensor_sight import CameraSight
from stepaside.core.poses import wrap_angle, wrap_angles
from stepaside.games import duel, run_game
from stepaside.games.game_settings import StartSettings
from stepaside.games.players import RobotPlayer
from stepaside.games.recorded_game import RecordedGame
from stepaside.perception.gaze import MAX_YAW, SCAN_SPEED
from stepaside.perception.pipeline import Perception
from stepaside.sim.camera_settings import CameraSettings, ColourSettings
from stepaside.sim.person_settings import PersonSettings

RAYS = CameraSettings(colour=ColourSettings(renderer="raycast"))
SEEING = duel(
    seed=2,
    duration=8.0,
    senses="cameras",
    cameras=RAYS,
    start=StartSettings(1.1, radians(20.0), radians(-10.0)),
)


def walkers(duel: RecordedGame) -> list[RobotPlayer]:
    return [
        player
        for player in duel.in_physics.players
        if isinstance(player, RobotPlayer)
    ]


def perception_of(walker: RobotPlayer) -> Perception:
    assert isinstance(walker.scheme.senses, CameraSight)
    return walker.scheme.senses.perception


@pytest.mark.slow
def test_the_pursuer_finds_an_opponent_outside_its_view() -> None:
    """It begins facing away, scans, and does not halt."""
    start = StartSettings(1.3, radians(-88.0), 0.0)
    settings = replace(SEEING, start=start, duration=4.0)
    pursuer = run_game(settings).pursuer
    assert pursuer.sight is not None and pursuer.landings is not None
    times, bearing, distance, true_bearing, true_distance, _ = pursuer.sight.T
    # Out of view at first, found by half a sweep of the head, never lost.
    assert true_bearing[0] > radians(85.0)
    found = int(np.argmax(np.isfinite(bearing)))
    assert 0.3 < times[found] < MAX_YAW / SCAN_SPEED
    assert np.isnan(bearing[:found]).all()
    assert np.isfinite(bearing[found:]).all()
    off = np.abs(bearing - true_bearing)[found:]
    assert np.degrees(np.median(off)) < 1.0 and np.degrees(off.max()) < 5.0
    misjudged = np.abs(distance - true_distance) / true_distance
    assert np.median(misjudged[found:]) < 0.05
    assert misjudged[found:].max() < 0.1  # no ear that is lost and found
    # From then on it walks step by step, and turns to the other.
    landings = pursuer.landings[:, 0]
    assert landings[0] < times[found] + 1.5
    np.testing.assert_allclose(np.diff(landings), 0.547, atol=1e-6)
    assert times[-1] - landings[-1] < 0.547
    assert true_bearing[-1] < true_bearing[found] - radians(20.0)


@pytest.mark.slow
def test_a_person_nearby_is_one_track_and_not_lost() -> None:
    """Two legs that swing, the trunk above the view."""
    person = PersonSettings("steer", 0.073, 0.146)
    start = StartSettings(0.95, 0.0, radians(10.0))
    settings = SEEING.changed(
        pursuer={"body": "person"}, person=person, start=start
    )
    duel = RecordedGame(replace(settings, duration=7.1))
    evader = walkers(duel)[0]
    perception, truth = perception_of(evader), evader.truth
    errors, ranges = [], []
    while duel.world.time < 7.0:
        assert duel.tick() is None
        seen = perception.sighting
        if duel.world.time < 1.0:
            continue
        assert seen is not None
        x, y = truth.position_torso_in_world
        u, v = duel.in_physics.players[0].truth.position_torso_in_world
        bearing = atan2(v - y, u - x) - truth.heading_in_world
        errors.append(degrees(abs(wrap_angle(seen.bearing - bearing))))
        ranges.append(abs(seen.distance - hypot(u - x, v - y)))
    assert np.median(errors) < 5.0 and max(errors) < 15.0
    assert np.median(ranges) < 0.08 and max(ranges) < 0.3


BEHIND = SEEING.changed(
    duration=2.0,
    pursuer={"body": "person"},
    person=PersonSettings("straight", 0.5),
    start=StartSettings(2.8, 0.0, radians(-170.0)),
)


@pytest.mark.slow
@pytest.mark.parametrize("rear", [False, True])
def test_a_rear_camera_shows_a_person_behind(rear: bool) -> None:
    cameras = replace(RAYS, rear_camera=rear)
    run = run_game(replace(BEHIND, cameras=cameras))
    sight = run.tracks["evader"].sight
    assert sight is not None
    time, bearing, distance, true, away, lost = sight.T
    known = (time > 1.5) & np.isfinite(bearing)
    if not rear:
        assert not known.any()
        return
    assert known.sum() == (time > 1.5).sum()
    error = wrap_angles(bearing[known] - true[known])
    assert np.degrees(np.abs(error)).max() < 5.0
    assert np.abs(distance[known] - away[known]).max() < 0.25
    assert not lost[known].any()
