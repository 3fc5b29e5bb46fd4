"""Test the physics of two robots: clock, sensors, servos, contacts."""

import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.outcome import Outcome
from stepaside.games.recorded_game import RecordedGame
from stepaside.games.robot_player import RobotPlayer
from stepaside.sim.physics_settings import PhysicsSettings


def standing(distance: float = 2.0, **changes: object) -> RecordedGame:
    start = StartSettings(distance, 0.3, -0.2)
    return RecordedGame(DuelSettings(start=start, **changes))  # type: ignore[arg-type]


def walkers(duel: RecordedGame) -> list[RobotPlayer]:
    return [
        player
        for player in duel.in_physics.players
        if isinstance(player, RobotPlayer)
    ]


@pytest.mark.parametrize("tick", [0.005, 0.003, 0.001])
def test_tick_that_is_no_multiple_of_the_step_is_refused(tick: float) -> None:
    with pytest.raises(ConfigurationError, match="multiple of time_step"):
        PhysicsSettings(time_step=0.002, tick=tick)


def test_foot_forces_of_a_standing_robot_sum_to_its_weight() -> None:
    """The evader stands: foot forces, accelerometer and gyro at rest."""
    duel = standing()
    for _ in range(200):
        duel.tick()
    evader = walkers(duel)[1]
    measured = evader.robot.read()
    weight = 5.305 * 9.81
    assert measured.foot_forces.sum() == pytest.approx(weight, rel=0.03)
    upward = measured.accelerometer[2]
    assert upward == pytest.approx(9.81, rel=0.02)
    np.testing.assert_allclose(measured.gyro, 0.0, atol=0.05)
    targets = evader.scheme.joint_targets
    np.testing.assert_allclose(measured.joint_positions, targets, atol=0.03)


def test_the_line_of_sight_measures_the_opponent() -> None:
    duel = standing(1.7)
    pursuer, evader = walkers(duel)
    sighting = pursuer.robot.read().sighting
    assert sighting is not None
    assert sighting.distance == pytest.approx(1.7, abs=0.05)
    assert sighting.bearing == pytest.approx(-0.3, abs=0.02)
    back = evader.robot.read().sighting
    assert back is not None
    assert back.bearing == pytest.approx(0.2, abs=0.02)


@pytest.mark.parametrize(
    ("distance", "expected"), [(0.12, Outcome.CONTACT), (1.5, None)]
)
def test_contact_ends_the_duel(
    distance: float, expected: Outcome | None
) -> None:
    """Both are placed upright at a distance."""
    duel = standing()
    assert duel.tick() is None
    pursuer, evader = (w.robot.qpos_slice.start for w in walkers(duel))
    qpos = duel.in_physics.data.qpos
    qpos[evader : evader + 7] = qpos[pursuer : pursuer + 7]
    qpos[evader] += distance
    assert duel.tick() is expected
    assert duel.distance == pytest.approx(distance, abs=0.02)
