"""Test that footsteps are drawn where the soles are."""

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.recorded_game import run_duel
from stepaside.games.run import DuelRun
from stepaside.locomotion.control_settings import ControlSettings
from stepaside.report.landed_footsteps import footsteps_in
from stepaside.report.scene import RunScene
from stepaside.sim.body_settings import BODIES

# Without feedback, the odometry of a pursuer that turns drifts by centimetres.
SETTINGS = DuelSettings(
    start=StartSettings(1.2, 1.4, 0.0),
    body=BODIES["hardware"],
    control=ControlSettings(feedback=False),
    duration=12.0,
)


@pytest.fixture(scope="module")
def run() -> DuelRun:
    return run_duel(SETTINGS)


def soles(run: DuelRun, footsteps: Array) -> Array:
    """Positions of the pursuer's soles in the middle of the next step."""
    scene, found = RunScene(run), []
    for time, side, *_ in footsteps.tolist():
        scene.put(run.index_at(time + 0.15))
        letter = "l" if side > 0.0 else "r"
        found.append(
            scene.data.site(f"pursuer/{letter}_sole_center").xpos[:2].copy()
        )
    return np.array(found)


def test_footsteps_of_a_run_are_where_the_soles_landed(run: DuelRun) -> None:
    found = footsteps_in(run)["pursuer"]
    planned = run.pursuer.landings
    assert planned is not None
    np.testing.assert_array_equal(found[:, :2], planned[: len(found), :2])
    inside = found[found[:, 0] < run.times[-1] - 0.2]
    away = np.linalg.norm(inside[:, 2:4] - soles(run, inside), axis=1)
    assert away.max() < 5e-3
    # Those of the plan, in odometry, are elsewhere.
    wrong = planned[: len(inside), 2:4] - soles(run, inside)
    assert np.linalg.norm(wrong, axis=1).max() > 0.03


def test_footsteps_that_have_not_landed_are_left_out(run: DuelRun) -> None:
    found = footsteps_in(run)["pursuer"]
    planned = run.pursuer.landings
    assert planned is not None
    assert len(found) in (len(planned), len(planned) - 1)
    assert found[-1, 0] <= run.times[-1]
