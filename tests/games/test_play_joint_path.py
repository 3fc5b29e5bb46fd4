"""Test the trajectory of a robot by its own odometry."""

from math import atan2

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from stepaside.core.poses import Array, Pose, wrap_angle
from stepaside.games.play_conversion import OdometryPath, PlayedRows
from stepaside.games.trajectory import Trajectory
from stepaside.planning import Foot, GaitSettings
from stepaside.robots.description import load_robot
from stepaside.robots.forward_kinematics import ForwardKinematics

NAO = load_robot("nao")
FORWARD = ForwardKinematics(NAO)
BENT = np.array([NAO.standing.get(name, 0.0) for name in FORWARD.tree.motors])
SUPPORT = Pose(0.4, -0.7, 2.2)
TILT = (0.07, -0.05)


def believed(forces: Array, foot: Foot = Foot.LEFT) -> Trajectory:
    """Return the trajectory of a leaning robot at one instant."""
    columns = {
        "joint_positions": BENT[None],
        "gyro": np.zeros((1, 3)),
        "accelerometer": np.array([[0.0, 0.0, 9.81]]),
        "foot_forces": forces[None],
        "mind": np.zeros(1),
        "support": np.array([[*SUPPORT, float(foot.value)]]),
        "com_reference": np.array([[0.1, 0.2]]),
        "zmp_reference": np.array([[0.3, 0.4]]),
        "begun": np.full((1, 6), np.nan),
        "state": np.zeros(1),
    }
    rows = PlayedRows(columns, np.zeros(1), ())
    body = OdometryPath(rows, NAO, np.array([TILT]))
    return body.track(GaitSettings(), np.full((1, 3), np.nan))


def shown(track: Trajectory) -> mujoco.MjData:
    """Return the torso of a trajectory in MuJoCo."""
    model = NAO.compile()
    data = mujoco.MjData(model)
    assert track.qpos is not None
    data.qpos[:] = track.qpos[0]
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    return data


@pytest.mark.parametrize("foot", Foot)
def test_the_robot_stands_on_its_support_foot_with_the_measured_tilt(
    foot: Foot,
) -> None:
    track = believed(np.zeros(8), foot)
    data = shown(track)
    name = NAO.left_foot if foot is Foot.LEFT else NAO.right_foot
    site = data.site(name)
    np.testing.assert_allclose(site.xpos, [*SUPPORT[:2], 0.0], atol=1e-6)
    axes = site.xmat.reshape(3, 3)
    off = wrap_angle(atan2(axes[1, 0], axes[0, 0]) - SUPPORT.theta)
    assert off == pytest.approx(0.0, abs=1e-6)
    torso = Rotation.from_matrix(data.body(NAO.torso).xmat.reshape(3, 3))
    heading, pitch, roll = torso.as_euler("ZYX").tolist()
    assert (roll, pitch) == pytest.approx(TILT, abs=1e-6)
    assert wrap_angle(heading - track.torso[0, 2]) == pytest.approx(
        0.0, abs=1e-6
    )
    np.testing.assert_allclose(track.com[0], data.subtree_com[0], atol=1e-5)


@pytest.mark.parametrize("foot", Foot)
def test_the_zmp_is_the_center_of_the_foot_forces(foot: Foot) -> None:
    """Four sensors are under each foot."""
    random = np.random.default_rng(2)
    under = FORWARD.force_sensors()
    for forces in (*np.diag(np.full(8, 30.0)), random.uniform(0, 9, 8)):
        track = believed(forces, foot)
        data, places = shown(track), []
        for number, (x, y) in enumerate(under.tolist()):
            site = data.site(NAO.left_foot if number < 4 else NAO.right_foot)
            place = site.xpos + site.xmat.reshape(3, 3) @ [x, y, 0.0]
            places.append(place[:2])
        assert track.zmp is not None
        wanted = forces @ np.array(places) / forces.sum()
        np.testing.assert_allclose(track.zmp[0], wanted, atol=1e-6)


def test_a_robot_without_foot_sensors_has_no_forces_on_record() -> None:
    """What is read back must be finite."""
    track = believed(np.full(8, np.nan))
    assert track.foot_forces is None
    assert track.zmp is not None and np.isnan(track.zmp).all()
