"""Test games of robots on learned legs."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("onnxruntime")

from legs_robot import nao_on_legs
from stepaside.games.game import play
from stepaside.games.game_settings import GameSettings, duel, read_game
from stepaside.games.players import RobotPlayer
from stepaside.games.recorded_game import RecordedGame
from stepaside.locomotion.policy.policy_legs import PolicyWalk
from stepaside.planning import Direction
from stepaside.strategies import Intent, Knowledge
from stepaside.strategies.velocity_set import BodyVelocity


@pytest.fixture(scope="module")
def standing(tmp_path_factory: pytest.TempPathFactory) -> GameSettings:
    """RecordedGame of robots whose policy holds the standing posture."""
    folder = nao_on_legs(tmp_path_factory.mktemp("legs") / "nao")
    settings = read_game(
        {"robot": str(folder)}, base=duel(duration=1.5, seed=3)
    )
    return replace(settings, start=replace(settings.start, distance=1.0))


class Sidestepper:
    """Strategy that walks to the left, and counts its decisions."""

    direction, saturated = Direction.BACKWARD, False

    def __init__(self) -> None:
        self.told: list[Knowledge] = []

    def begin(self) -> None:
        """Return no memory."""

    def decide(self, known: Knowledge, memory: None) -> tuple[Intent, None]:
        """Walk to the left."""
        self.told.append(known)
        return Intent(velocity=BodyVelocity(0.0, 0.2, 0.1)), None


def test_a_body_velocity_reaches_the_policy_every_80_ms(
    standing: GameSettings,
) -> None:
    strategy = Sidestepper()
    duel = RecordedGame(standing, strategies={"evader": strategy})
    _, evader = duel.in_physics.players
    assert isinstance(evader, RobotPlayer)
    walk = evader.scheme.locomotion
    assert isinstance(walk, PolicyWalk)
    play(duel)
    assert walk.legs.intended == BodyVelocity(0.0, 0.2, 0.1)
    velocities = strategy.told[-1].limits.velocities
    assert velocities == walk.velocities
    assert velocities is not None and velocities.lateral == (-1.0, 1.0)
    told = [each for each in strategy.told if each.limits.velocities]
    times = np.unique([known.time for known in told if known.moving])
    np.testing.assert_allclose(np.diff(times), 0.08, atol=1e-9)
