"""Test that each column of a walk holds the quantity of its name."""

import mujoco
import numpy as np
import pytest

from fake_robot import walk_of
from stepaside.core.poses import Array, Pose
from stepaside.games.recorded_game import RecordedGame
from stepaside.games.recorder import Recorder
from stepaside.games.support_foot_columns import (
    COLUMNS,
    express_in_support_foot,
)
from stepaside.games.walk_settings import WalkSettings
from stepaside.locomotion.zmp.control_settings import STABILISED
from stepaside.locomotion.zmp.feedback_loop import ClosedLoop
from stepaside.locomotion.zmp.state_estimator import BodyState
from stepaside.planning import Foot
from walkers import walker_of


@pytest.fixture(scope="module")
def walking() -> RecordedGame:
    """Return a robot that has walked a few steps in a circle."""
    made = RecordedGame(WalkSettings(bearing=0.6, control=STABILISED))
    for _ in range(1100):
        assert made.tick() is None
    return made


def recorder(walking: RecordedGame) -> Recorder:
    """Return an additional recorder of a walk."""
    return Recorder(walking.in_physics, closely=True)


def columns(made: Recorder) -> dict[str, Array]:
    return express_in_support_foot(made.times, made.tracks()["walker"])


def last(walking: RecordedGame) -> dict[str, float]:
    made = recorder(walking)
    made.every = 1
    made.before(walking)
    arrays = columns(made)
    assert tuple(arrays) == COLUMNS
    return {name: float(values[0]) for name, values in arrays.items()}


def test_a_walk_is_expressed_in_the_frame_of_the_support_foot(
    walking: RecordedGame,
) -> None:
    """True values, references and estimates agree in one frame."""
    walker = walker_of(walking)
    seen = last(walking)
    assert seen["time"] == walking.world.time
    foot = walker.scheme.locomotion.step(walking.world.time).swing.other
    assert seen["support"] == foot.value
    truth = walker.robot.truth
    heading = truth.heading_in_world
    assert abs(heading) > 0.2
    assert seen["heading"] == pytest.approx(heading)
    assert seen["heading_reference"] == pytest.approx(
        walker.scheme.kinematics.torso_heading
    )
    assert seen["heading_reference"] == pytest.approx(heading, abs=0.05)
    np.testing.assert_allclose(
        [seen["com_in_world_x"], seen["com_in_world_y"]],
        truth.position_com_in_world[:2],
    )
    np.testing.assert_allclose(
        [seen["com_reference_in_world_x"], seen["com_reference_in_world_y"]],
        walker.scheme.state.reference.com[:2],
    )
    for name, tolerance in (("com_x", 0.004), ("com_y", 0.004)):
        wanted = seen[name.replace("com", "com_reference")]
        assert seen[name] == pytest.approx(wanted, abs=0.01)
        assert seen[name] == pytest.approx(
            seen[f"estimated_{name}"], abs=tolerance
        )
    # The CoM is nearer the middle than the foot is: on its other side.
    assert -0.1 < foot.value * seen["com_y"] < 0.0
    assert abs(seen["com_x"]) < 0.06


def test_vectors_are_rotated_and_points_transformed(
    walking: RecordedGame,
) -> None:
    """The pose of the foot is recovered from the columns."""
    walker = walker_of(walking)
    seen = last(walking)
    foot = walker.scheme.locomotion.step(walking.world.time).swing.other
    description = walker.scheme.kinematics.description
    name = {
        Foot.LEFT: description.left_foot,
        Foot.RIGHT: description.right_foot,
    }[foot]
    data = walking.in_physics.data
    place = data.site(f"walker/{name}")
    heading = np.arctan2(place.xmat[3], place.xmat[0])
    frame = Pose(place.xpos[0], place.xpos[1], float(heading))
    assert (seen["foot_in_world_x"], seen["foot_in_world_y"]) == (
        frame.x,
        frame.y,
    )
    com = frame.transform_points([[seen["com_x"], seen["com_y"]]])[0]
    np.testing.assert_allclose(
        com, walker.robot.truth.position_com_in_world[:2]
    )
    zmp = frame.transform_points([[seen["zmp_x"], seen["zmp_y"]]])[0]
    np.testing.assert_allclose(zmp, walker.robot.measured_zmp())
    model = walking.in_physics.model
    torso = model.body(f"walker/{description.torso}").id
    slopes = np.zeros((3, model.nv))
    mujoco.mj_jacSubtreeCom(model, data, slopes, torso)
    speed = slopes @ data.qvel
    assert np.hypot(*speed[:2]) > 0.01
    turned = Pose(0.0, 0.0, float(heading))
    velocity = [[seen["velocity_x"], seen["velocity_y"]]]
    np.testing.assert_allclose(
        turned.transform_points(velocity)[0],
        speed[:2],
        atol=2e-3,  # places and speeds are one physics step apart
    )
    support = walker.scheme.locomotion.step(walking.world.time).support
    for column, point in (
        ("com_reference", walker.scheme.state.reference.com[:2]),
        ("zmp_reference", walker.scheme.state.zmp_reference),
    ):
        there = [[seen[f"{column}_x"], seen[f"{column}_y"]]]
        np.testing.assert_allclose(
            support.transform_points(there)[0], point, atol=1e-12
        )


def test_tilt_is_roll_and_pitch_of_the_torso(walking: RecordedGame) -> None:
    data = walking.in_physics.data
    before = data.qpos.copy()
    for roll, pitch in ((0.2, 0.1), (-0.3, 0.05)):
        yaw = np.zeros(4)
        mujoco.mju_euler2Quat(yaw, [roll, pitch, 0.8], "XYZ")
        data.qpos[3:7] = yaw
        mujoco.mj_forward(walking.in_physics.model, data)
        seen = last(walking)
        assert seen["roll"] == pytest.approx(roll)
        assert seen["pitch"] == pytest.approx(pitch)
    data.qpos[:] = before
    mujoco.mj_forward(walking.in_physics.model, data)


def test_estimates_are_in_the_frame_of_the_support_foot(
    walking: RecordedGame,
) -> None:
    walker = walker_of(walking)
    balance = walk_of(walker.scheme).balance
    assert isinstance(balance, ClosedLoop)
    stabiliser = balance.stabiliser
    state = BodyState(
        *((1.0, 2.0), (0.3, 0.4), (9.0, 9.0), (1.5, 2.5), (0.01, 0.02)),
        *((0.0, 0.0, 0.0), 0.5, 50.0),
    )
    before, stabiliser.state = stabiliser.state, state
    seen = last(walking)
    support = walker.scheme.locomotion.step(walking.world.time).support
    turned = Pose(0.0, 0.0, support.theta)
    for name, frame, value in (
        ("com", support, state.com),
        ("velocity", turned, state.velocity),
        ("zmp", support, state.zmp),
    ):
        there = [[seen[f"estimated_{name}_x"], seen[f"estimated_{name}_y"]]]
        found = frame.transform_points(there)[0]
        np.testing.assert_allclose(found, value, atol=1e-12)
    assert (seen["estimated_roll"], seen["estimated_pitch"]) == state.tilt
    stabiliser.state = None
    estimates = [v for n, v in last(walking).items() if "estimated" in n]
    assert len(estimates) == 8 and np.isnan(estimates).all()
    stabiliser.state = before
