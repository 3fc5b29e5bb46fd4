"""Test that the outline contains the robot, standing and walking."""

import mujoco
import numpy as np
import pytest

from fake_robot import GAIT
from stepaside.arena import BODY_RADIUS
from stepaside.core.poses import Array, Pose
from stepaside.games.game_settings import StartSettings
from stepaside.games.game_settings import duel as make_duel
from stepaside.games.players import RobotPlayer
from stepaside.games.recorded_game import RecordedGame
from stepaside.robots.description import load_robot
from stepaside.sim.outline_measurement import (
    extents,
    measure_outline,
    reach_of,
    solid_geoms,
)

NAO = measure_outline(load_robot("nao"), GAIT)
ANGLES = np.arange(64) * (2.0 * np.pi / 64)
AROUND = np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=-1)


def reach_along(duel: RecordedGame, name: str) -> Array:
    """How far all that can collide reaches, along 64 ways."""
    model, data = duel.in_physics.model, duel.in_physics.data
    most = np.full(len(AROUND), -np.inf)
    root = model.body(f"{name}/torso").rootid[0]
    for geom in range(model.ngeom):
        body = model.geom_bodyid[geom]
        if model.body_rootid[body] != root or not model.geom_contype[geom]:
            continue
        axes, kind = data.geom_xmat[geom].reshape(3, 3), model.geom_type[geom]
        size, bulge = model.geom_size[geom].copy(), 0.0
        if kind != mujoco.mjtGeom.mjGEOM_BOX:  # ends of a capsule, or centre
            bulge = size[0]
            capsule = kind == mujoco.mjtGeom.mjGEOM_CAPSULE
            size[:] = 0.0, 0.0, size[1] if capsule else 0.0
        signs = np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1).T
        corners = data.geom_xpos[geom] + signs * size @ axes.T
        found = (corners[:, :2] @ AROUND.T).max(axis=0) + bulge
        most = np.maximum(most, found)
    return most


def test_a_nao_is_as_wide_as_its_arms_and_as_long_as_its_trunk() -> None:
    assert np.abs(NAO.trunk[:, 1]).max() > 0.14
    assert np.hypot(*NAO.trunk.T).max() < BODY_RADIUS
    left, right = NAO.left_sole, NAO.right_sole
    np.testing.assert_allclose(left.max(axis=0), [0.095, 0.042], atol=1e-6)
    np.testing.assert_allclose(left.min(axis=0), [-0.05, -0.035], atol=1e-6)
    mirrored = right * [1, -1]
    np.testing.assert_allclose(mirrored.max(axis=0), left.max(axis=0))
    np.testing.assert_allclose(mirrored.min(axis=0), left.min(axis=0))


def test_shapes_reach_as_far_as_their_surfaces() -> None:
    """Tilted shapes of all kinds, against distances that MuJoCo measures."""
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body(pos=[0.3, -0.2, 0.5])
    rotation = [0.9, 0.3, -0.2, 0.25]
    for kind in ("SPHERE", "CAPSULE", "CYLINDER", "ELLIPSOID", "BOX"):
        body.add_geom(
            type=getattr(mujoco.mjtGeom, f"mjGEOM_{kind}"),
            size=[0.1, 0.2, 0.15],
            quat=rotation,
        )
    far, half = 4.0, 0.5
    wall = spec.worldbody.add_body(mocap=True)
    wall.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[half, 9.0, 9.0])
    model = spec.compile()
    data = mujoco.MjData(model)
    geoms = solid_geoms(model, 1)
    assert len(geoms) == 5
    for angle in (0.0, 0.7, 2.0, 4.4):
        way = np.array([np.cos(angle), np.sin(angle), 0.0])
        data.mocap_pos[0] = far * way
        data.mocap_quat[0] = [np.cos(angle / 2), 0.0, 0.0, np.sin(angle / 2)]
        mujoco.mj_forward(model, data)
        found = extents(model, data, geoms, way[None])[:, 0]
        for geom, reach in zip(geoms, found, strict=True):
            gap = mujoco.mj_geomDistance(model, data, geom, 5, 9.0, None)
            assert far - half - gap == pytest.approx(reach, abs=1e-4)


def test_circle_around_a_body_contains_an_arm_to_its_side() -> None:
    """A level capsule, 0.2 m long with its caps, begins 0.3 m away."""
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><body><geom type='capsule' size='0.02' "
        "fromto='1 -0.32 0.5 1 -0.48 0.5'/></body></worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    found = reach_of(model, data, np.array([0]), (1.0, 0.0))
    assert 0.5 <= found < 0.5 * 1.001


@pytest.mark.slow
def test_a_walking_body_stays_within_its_outline_by_the_margin() -> None:
    """All shapes, of two NAOs in physics, against what was planned."""
    settings = make_duel(
        seed=3, start=StartSettings(0.75, 0.8, 0.1), duration=9.0
    )
    duel = RecordedGame(settings, endless=True)
    beyond = []
    while duel.world.time < settings.duration:
        assert duel.tick() is None
        if duel.in_physics.ticks % 10:
            continue
        for player in duel.in_physics.players:
            assert isinstance(player, RobotPlayer)
            body = player.scheme.walk.reference
            corners = np.concatenate(
                [
                    Pose(*place[:2], heading).transform_points(part)
                    for place, heading, part in (
                        (body.com, body.heading, NAO.trunk),
                        (body.left_foot, body.left_foot[3], NAO.left_sole),
                        (body.right_foot, body.right_foot[3], NAO.right_sole),
                    )
                ]
            )
            # Odometry drifts; who knows a room is told its place in it.
            truth = player.truth
            x, y, _ = truth.position_com_in_world.tolist()
            at = Pose(x, y, truth.heading_in_world)
            odometry = at.compose(Pose(*body.com[:2], body.heading).inverse())
            planned = (odometry.transform_points(corners) @ AROUND.T).max(0)
            beyond.append(
                float((reach_along(duel, player.name) - planned).max())
            )
    assert max(beyond) < settings.map.margin
