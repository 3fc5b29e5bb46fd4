"""Test the recorded motion of a robot against its state at each sample."""

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.games import DuelSettings
from stepaside.games.duel import Duel
from stepaside.games.match import Match, play
from stepaside.games.outcome import Outcome
from stepaside.games.walker import SimulatedPlayer
from stepaside.sim.body_settings import BODIES

QUANTITIES = ("com", "place", "torso", "zmp", "com_reference", "zmp_reference")


class Witness:
    """Observer that notes the state of both robots at each sample."""

    def __init__(self) -> None:
        self.rows: dict[str, list[Array]] = {}

    def before(self, match: Match) -> None:
        """Note what the recorder samples."""
        assert isinstance(match, Duel)
        if match.world.ticks % match.recorder.every:
            return
        for player in match.players:
            assert isinstance(player, SimulatedPlayer)
            seen = player.snapshot()
            assert seen.walk is not None and seen.frame is not None
            planned = np.array(
                [seen.walk.reference.com[:2], seen.walk.zmp_reference]
            )
            com, zmp = seen.frame.transform_points(planned)
            values = (seen.com, seen.place, seen.torso, seen.zmp, com, zmp)
            for name, value in zip(QUANTITIES, values, strict=True):
                self._add(f"{player.name}_{name}", np.array(value))
            self._add(f"{player.name}_qpos", player.robot.posture)

    def _add(self, name: str, value: Array) -> None:
        self.rows.setdefault(name, []).append(value)

    def acted(self, match: Match) -> None:
        """Do nothing."""

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Do nothing."""


@pytest.mark.parametrize("body", ["ideal", "hardware"])
def test_each_array_holds_the_quantity_of_its_name(body: str) -> None:
    witness = Witness()
    duel = Duel(DuelSettings(seed=3, body=BODIES[body]), (witness,))
    outcome, wall_time = play(duel, 1.2)
    run = duel.run(outcome, wall_time)
    count = len(run.times) - 1  # the last sample is taken at the end
    assert count > 40
    for name, track in run.tracks.items():
        arrays = track.arrays(name)
        for key in (*QUANTITIES, "qpos"):
            seen = np.array(witness.rows[f"{name}_{key}"])
            np.testing.assert_allclose(
                arrays[f"{name}_{key}"][:count], seen, atol=2e-7, rtol=1e-6
            )
