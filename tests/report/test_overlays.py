"""What lies over a scene: laws of its lines."""

import numpy as np

from stepaside.games.game_settings import StartSettings, duel
from stepaside.games.recorded_game import run_game
from stepaside.locomotion.control_settings import ControlSettings
from stepaside.report.overlays import footsteps_in
from stepaside.report.scene import RunScene
from stepaside.sim.body_settings import BODIES


def test_footsteps_of_a_run_are_where_the_soles_landed() -> None:
    """Without feedback, the odometry of a pursuer that turns drifts."""
    run = run_game(
        duel(
            start=StartSettings(1.2, 1.4, 0.0),
            body=BODIES["hardware"],
            control=ControlSettings(feedback=False),
            duration=12.0,
        )
    )
    found, planned = footsteps_in(run, "pursuer"), run.pursuer.landings
    assert planned is not None
    np.testing.assert_array_equal(found[:, :2], planned[: len(found), :2])
    assert len(found) in (len(planned), len(planned) - 1)
    assert found[-1, 0] <= run.times[-1]
    scene, stood = RunScene(run), []
    inside = found[found[:, 0] < run.times[-1] - 0.2]
    for time, side, *_ in inside.tolist():  # in the middle of the next step
        scene.put(run.index_at(time + 0.15))
        site = f"pursuer/{'l' if side > 0.0 else 'r'}_sole_center"
        stood.append(scene.data.site(site).xpos[:2].copy())
    away = np.linalg.norm(inside[:, 2:4] - stood, axis=1)
    assert away.max() < 5e-3
    # Those of the plan, in odometry, are elsewhere.
    wrong = planned[: len(inside), 2:4] - stood
    assert np.linalg.norm(wrong, axis=1).max() > 0.03
