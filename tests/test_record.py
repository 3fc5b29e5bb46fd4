"""Records of runs: every column holds what its name says."""

from math import pi
from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest

from stepaside.control.balance.estimation import BodyState
from stepaside.control.balance.settings import STABILISED
from stepaside.games.record import Recorder
from stepaside.games.walk import Walker, WalkSettings
from stepaside.games.walk_record import COLUMNS, WalkRecorder
from stepaside.planning import Foot
from stepaside.poses import Array, Pose
from stepaside.world.settings import PhysicsSettings


def fake(number: int, qpos: Array, world: Any) -> tuple[Any, Any]:
    """Robot and scheme whose every quantity tells whose and what it is."""
    base = 100.0 * number
    truth = SimpleNamespace(
        com=base + np.array([1.0, 2.0, 3.0]),
        position=(base + 4.0, base + 5.0),
        heading=0.5 * number,
    )
    robot = SimpleNamespace(
        name=("pursuer", "evader")[number],
        world=world,
        truth=truth,
        measured_zmp=lambda: (base + 6.0, base + 7.0),
        qpos_slice=slice(3 * number, 3 * number + 3),
    )
    scheme = SimpleNamespace(
        reference=SimpleNamespace(com=(base + 8.0, base + 9.0, 0.3)),
        zmp_reference=(base + 10.0, base + 11.0),
        landings=[
            (1.0, Foot.LEFT, Pose(0.3, 0.1, 0.2)),
            (1.4, Foot.RIGHT, Pose(0.4, -0.1, 0.3)),
        ],
    )
    return robot, scheme


def recorder(tick: float = 0.004) -> tuple[Recorder, Any, list[Any]]:
    qpos = np.arange(6.0)
    world = SimpleNamespace(
        data=SimpleNamespace(qpos=qpos),
        time=0.0,
        physics=SimpleNamespace(tick=tick),
    )
    robots, schemes = zip(*(fake(i, qpos, world) for i in (0, 1)), strict=True)
    frames = (Pose(0.0, 0.0, 0.0), Pose(1.0, 2.0, pi / 2))
    made: Recorder = Recorder(robots, schemes, frames)
    return made, world, list(robots)


def test_a_record_holds_each_quantity_under_its_name() -> None:
    """References are in odometry, which the evader's frame turns."""
    made, world, robots = recorder()
    made.sample()
    world.time = 0.02
    world.data.qpos += 0.5
    made.sample()
    arrays = made.arrays()
    np.testing.assert_array_equal(arrays["times_s"], [0.0, 0.02])
    for number, name in enumerate(("pursuer", "evader")):
        base = 100.0 * number
        for row in (0, 1):
            np.testing.assert_allclose(
                arrays[f"{name}_com"][row], base + np.array([1, 2, 3])
            )
            np.testing.assert_allclose(
                arrays[f"{name}_torso"][row],
                [base + 4.0, base + 5.0, 0.5 * number],
            )
            np.testing.assert_allclose(
                arrays[f"{name}_zmp"][row], [base + 6.0, base + 7.0]
            )
            posture = np.arange(3.0) + 3.0 * number + 0.5 * row
            np.testing.assert_array_equal(arrays[f"{name}_qpos"][row], posture)
    np.testing.assert_allclose(arrays["pursuer_com_reference"][0], [8, 9])
    np.testing.assert_allclose(arrays["pursuer_zmp_reference"][0], [10, 11])
    np.testing.assert_allclose(
        arrays["evader_com_reference"][0], [1 - 109, 2 + 108]
    )
    np.testing.assert_allclose(
        arrays["evader_zmp_reference"][0], [1 - 111, 2 + 110]
    )
    assert arrays["pursuer_qpos"].dtype == np.float32
    assert set(arrays) == {"times_s"} | {
        f"{robot.name}_{key}"
        for robot in robots
        for key in (
            *("com", "torso", "com_reference", "zmp_reference", "zmp"),
            *("qpos", "landings"),
        )
    }


def test_landings_are_in_the_world_with_their_side() -> None:
    made, _, _ = recorder()
    made.sample()
    arrays = made.arrays()
    np.testing.assert_allclose(
        arrays["pursuer_landings"],
        [[1.0, 1.0, 0.3, 0.1, 0.2], [1.4, -1.0, 0.4, -0.1, 0.3]],
    )
    np.testing.assert_allclose(
        arrays["evader_landings"],
        [
            [1.0, 1.0, 1.0 - 0.1, 2.0 + 0.3, 0.2 + pi / 2],
            [1.4, -1.0, 1.0 + 0.1, 2.0 + 0.4, 0.3 + pi / 2],
        ],
    )


def test_headings_pass_their_wrap_without_a_jump() -> None:
    made, _, robots = recorder()
    for heading in (3.0, -3.1, -2.9):
        robots[0].truth.heading = heading
        made.sample()
    headings = made.arrays()["pursuer_torso"][:, 2]
    expected = [3.0, 2 * pi - 3.1, 2 * pi - 2.9]
    np.testing.assert_allclose(headings, expected)


def test_an_empty_record_keeps_its_shapes() -> None:
    made, _, _ = recorder()
    made._schemes[0].landings.clear()
    made.sample()
    arrays = made.arrays()
    assert arrays["pursuer_landings"].shape == (0, 5)


@pytest.mark.parametrize(
    ("tick", "every"), [(0.004, 5), (0.012, 2), (0.002, 10), (0.06, 1)]
)
def test_samples_are_about_20_ms_apart(tick: float, every: int) -> None:
    assert recorder(tick)[0].every == every


@pytest.fixture(scope="module")
def walker() -> Walker:
    """A robot that has walked a few steps in a circle, with feedback."""
    made = Walker(WalkSettings(bearing=0.6, control=STABILISED))
    for _ in range(1100):
        assert made.tick()
    return made


def last(walker: Walker) -> dict[str, float]:
    made = WalkRecorder(walker.robot, walker.scheme)
    made.sample()
    arrays = made.arrays()
    assert tuple(arrays) == COLUMNS
    return {name: float(values[0]) for name, values in arrays.items()}


def test_a_walk_is_seen_from_the_foot_that_stands(walker: Walker) -> None:
    """Truth, wish and estimate agree in a frame that all three share."""
    seen = last(walker)
    assert seen["time"] == walker.world.time
    foot = walker.scheme.step(walker.world.time).swing.other
    assert seen["support"] == foot.value
    truth = walker.robot.truth
    heading = truth.heading
    assert abs(heading) > 0.2
    assert seen["heading"] == pytest.approx(heading)
    assert seen["asked_heading"] == pytest.approx(
        walker.scheme.kinematics.torso_heading
    )
    assert seen["asked_heading"] == pytest.approx(heading, abs=0.05)
    np.testing.assert_allclose(
        [seen["world_x"], seen["world_y"]], truth.com[:2]
    )
    np.testing.assert_allclose(
        [seen["asked_x"], seen["asked_y"]], walker.scheme.reference.com[:2]
    )
    for name, tolerance in (("com_x", 0.004), ("com_y", 0.004)):
        wanted = seen[name.replace("com", "reference")]
        assert seen[name] == pytest.approx(wanted, abs=0.01)
        assert seen[name] == pytest.approx(
            seen[f"estimated_{name}"], abs=tolerance
        )
    # The CoM is nearer the middle than the foot is: on its other side.
    assert -0.1 < foot.value * seen["com_y"] < 0.0
    assert abs(seen["com_x"]) < 0.06


def test_vectors_turn_with_the_foot_and_points_move_too(
    walker: Walker,
) -> None:
    """The foot's place and heading, found again from the columns."""
    seen = last(walker)
    foot = walker.scheme.step(walker.world.time).swing.other
    description = walker.scheme.kinematics.description
    name = {
        Foot.LEFT: description.left_foot,
        Foot.RIGHT: description.right_foot,
    }[foot]
    data = walker.world.data
    place = data.site(f"walker/{name}")
    heading = np.arctan2(place.xmat[3], place.xmat[0])
    frame = Pose(place.xpos[0], place.xpos[1], float(heading))
    assert (seen["foot_x"], seen["foot_y"]) == (frame.x, frame.y)
    com = frame.transform_points([[seen["com_x"], seen["com_y"]]])[0]
    np.testing.assert_allclose(com, walker.robot.truth.com[:2])
    zmp = frame.transform_points([[seen["zmp_x"], seen["zmp_y"]]])[0]
    np.testing.assert_allclose(zmp, walker.robot.measured_zmp())
    model = walker.world.model
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
    support = walker.scheme.step(walker.world.time).support
    for column, point in (
        ("reference", walker.scheme.reference.com[:2]),
        ("zmp_reference", walker.scheme.zmp_reference),
    ):
        there = [[seen[f"{column}_x"], seen[f"{column}_y"]]]
        np.testing.assert_allclose(
            support.transform_points(there)[0], point, atol=1e-12
        )


def test_the_torsos_lean_is_roll_and_pitch(walker: Walker) -> None:
    data = walker.world.data
    before = data.qpos.copy()
    for roll, pitch in ((0.2, 0.1), (-0.3, 0.05)):
        yaw = np.zeros(4)
        mujoco.mju_euler2Quat(yaw, [roll, pitch, 0.8], "XYZ")
        data.qpos[3:7] = yaw
        mujoco.mj_forward(walker.world.model, data)
        seen = last(walker)
        assert seen["roll"] == pytest.approx(roll)
        assert seen["pitch"] == pytest.approx(pitch)
    data.qpos[:] = before
    mujoco.mj_forward(walker.world.model, data)


def test_what_was_estimated_is_seen_from_the_foot_too(walker: Walker) -> None:
    stabiliser = walker.scheme.stabiliser
    assert stabiliser is not None
    state = BodyState(
        *((1.0, 2.0), (0.3, 0.4), (9.0, 9.0), (1.5, 2.5), (0.01, 0.02)),
        *((0.0, 0.0, 0.0), 0.5, 50.0),
    )
    before, stabiliser.state = stabiliser.state, state
    seen = last(walker)
    support = walker.scheme.step(walker.world.time).support
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
    estimates = [v for n, v in last(walker).items() if "estimated" in n]
    assert len(estimates) == 8 and np.isnan(estimates).all()
    stabiliser.state = before


def test_single_support_lasts_while_a_foot_swings() -> None:
    """Not before the walk, and not while both feet stand."""
    walker = Walker(WalkSettings())
    assert last(walker)["single"] == 0.0
    gait = walker.settings.gait
    singles, heights = [], []
    while walker.world.time < 3.0:
        assert walker.tick()
        singles.append(last(walker)["single"])
        feet = walker.scheme.reference
        heights.append(max(feet.left_foot[2], feet.right_foot[2]))
    single, lifted = np.array(singles) > 0.5, np.array(heights) > 1e-3
    assert single[lifted].mean() > 0.97
    cycle = round(2.0 * gait.step_duration / 0.004)
    share = gait.single_support / gait.step_duration
    assert single[-cycle:].mean() == pytest.approx(share, abs=0.01)


@pytest.mark.parametrize(
    ("tick", "every"), [(0.004, 5), (0.012, 2), (0.002, 10), (0.06, 1)]
)
def test_samples_of_a_walk_are_about_20_ms_apart(
    tick: float, every: int
) -> None:
    walker = Walker(WalkSettings(physics=PhysicsSettings(tick=tick)))
    made = WalkRecorder(walker.robot, walker.scheme)
    assert made.every == every
    assert made.arrays()["time"].shape == (0,)
