"""Test that a duel goes the same way where nothing is compiled."""

import os
import subprocess
import sys

import numpy as np
import pytest

DUEL = """
import sys
from stepaside.games.recorded_game import RecordedGame
from stepaside.games.game_settings import duel as make_duel
from stepaside.locomotion.control_settings import STABILISED
from stepaside.sim.body_settings import BODIES

body = {"body": BODIES["hardware"], "control": STABILISED}
duel = RecordedGame(make_duel(seed=1, duration=5.0, **body))
while duel.world.time < 5.0 and duel.tick() is None:
    pass
assert ("numba" in sys.modules) is (sys.argv[1] == "0")
print(*duel.in_physics.data.qpos)
"""


@pytest.mark.parametrize("body", ["ideal", "hardware"])
def test_a_duel_without_compilation_ends_in_the_same_posture(
    body: str,
) -> None:
    code = DUEL if body == "hardware" else DUEL.replace("**body", "")
    found = []
    for disabled in ("0", "1"):
        done = subprocess.run(
            [sys.executable, "-c", code, disabled],
            env=os.environ | {"NUMBA_DISABLE_JIT": disabled},
            capture_output=True,
            text=True,
            check=True,
        )
        found.append(np.array(done.stdout.split(), dtype=float))
    assert np.abs(found[0]).max() > 0.1
    np.testing.assert_allclose(found[0], found[1], atol=1e-9)
