"""Test the physics of two robots: clock, sensors, servos, contacts."""

import mujoco
import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Pose
from stepaside.games.duel import Duel
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.outcome import Outcome
from stepaside.games.walker import SimulatedPlayer
from stepaside.robots.description import load_robot
from stepaside.sim.physics_settings import PhysicsSettings, SightSettings
from stepaside.sim.world import World, build_model, transform_free_joint


def standing(distance: float = 2.0, **changes: object) -> Duel:
    start = StartSettings(distance, 0.3, -0.2)
    return Duel(DuelSettings(start=start, **changes))  # type: ignore[arg-type]


def walkers(duel: Duel) -> list[SimulatedPlayer]:
    return [
        player
        for player in duel.players
        if isinstance(player, SimulatedPlayer)
    ]


def test_dense_and_sparse_solvers_agree_in_contact() -> None:
    """MuJoCo 4.0.0 was wrong here, at just this number of joints."""
    duel = standing()
    for _ in range(50):
        assert duel.tick() is None
    model, data = duel.world.model, duel.world.data
    found = []
    for jacobian in (
        mujoco.mjtJacobian.mjJAC_DENSE,
        mujoco.mjtJacobian.mjJAC_SPARSE,
    ):
        model.opt.jacobian = jacobian
        other = mujoco.MjData(model)
        other.qpos[:], other.qvel[:] = data.qpos, data.qvel
        other.ctrl[:] = data.ctrl
        mujoco.mj_forward(model, other)
        assert other.ncon >= 12
        found.append(other.qacc.copy())
    np.testing.assert_allclose(found[0], found[1], atol=1e-5, rtol=1e-5)


def test_mujoco_is_not_the_release_with_the_wrong_solver() -> None:
    assert mujoco.__version__ != "4.0.0"


@pytest.mark.parametrize("tick", [0.005, 0.003, 0.001])
def test_tick_that_is_no_multiple_of_the_step_is_refused(tick: float) -> None:
    with pytest.raises(ConfigurationError, match="multiple of time_step"):
        PhysicsSettings(time_step=0.002, tick=tick)


def test_time_is_a_count_of_ticks() -> None:
    duel = standing()
    for _ in range(250):
        duel.tick()
    assert duel.world.time == 250 * 0.004
    assert duel.world.data.time == pytest.approx(1.0, abs=1e-9)


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


def test_delay_and_rate_age_the_sighting() -> None:
    sight = SightSettings(delay=0.1, rate=10.0)
    duel = standing(sight=sight)
    pursuer = walkers(duel)[0]
    ages = []
    for _ in range(250):
        duel.tick()
        seen = pursuer.scheme.sighting
        if seen is not None:
            ages.append(duel.world.time - seen.time)
    assert min(ages) >= 0.1 - 1e-9
    assert 0.19 < max(ages) < 0.21


def test_sight_noise_has_the_set_deviation_and_repeats() -> None:
    def bearings() -> np.ndarray:
        duel = standing(sight=SightSettings(bearing_noise=0.05))
        evader = walkers(duel)[1].robot
        found = []
        for _ in range(200):
            sighting = evader.read().sighting
            assert sighting is not None
            found.append(sighting.bearing)
            duel.world.ticks += 1  # only the clock moves
        return np.array(found)

    one, other = bearings(), bearings()
    np.testing.assert_array_equal(one, other)
    assert 0.04 < one.std() < 0.06


def test_servos_respect_the_speed_limits() -> None:
    duel = standing()
    walker = walkers(duel)[0]
    robot = walker.robot
    far = robot.read().joint_positions + 1.0
    robot.write(far)
    before = duel.world.data.ctrl.copy()
    robot.write(far)
    limits = load_robot("nao").speed_limits
    names = walker.scheme.kinematics.joint_names
    expected = [limits[name] * 0.004 for name in names]
    moved = (duel.world.data.ctrl - before)[: len(names)]
    np.testing.assert_allclose(moved, expected)


def test_robots_touch_within_each_others_arms() -> None:
    robots = dict.fromkeys(("pursuer", "evader"), load_robot("nao"))
    world = World(robots, PhysicsSettings())
    data = world.data
    size = world.model.nq // 2
    for index, x in enumerate((0.0, 0.12)):
        data.qpos[index * size : index * size + 7] = (x, 0, 0.33, 1, 0, 0, 0)
    mujoco.mj_forward(world.model, data)
    assert world.robots_touch()
    assert world.touching() == ("evader", "pursuer")
    data.qpos[size] = 1.5
    mujoco.mj_forward(world.model, data)
    assert not world.robots_touch() and world.touching() == ()


def test_a_robot_in_an_object_touches_it() -> None:
    """The floor does not count."""

    def furnish(spec: mujoco.MjSpec) -> None:
        box = spec.worldbody.add_body(pos=[0.0, 0.0, 0.1])
        box.add_geom(size=[0.1, 0.1, 0.1], type=mujoco.mjtGeom.mjGEOM_BOX)

    robots = {"pursuer": load_robot("nao")}
    world = World(robots, PhysicsSettings(), furnish=furnish)
    for x, names in ((0.12, ("a thing", "pursuer")), (2.0, ())):
        world.data.qpos[:7] = (x, 0, 0.33, 1, 0, 0, 0)
        mujoco.mj_forward(world.model, world.data)
        assert world.touching() == names
        assert world.robots_touch() is bool(names)


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
    qpos = duel.world.data.qpos
    qpos[evader : evader + 7] = qpos[pursuer : pursuer + 7]
    qpos[evader] += distance
    assert duel.tick() is expected
    assert duel.distance == pytest.approx(distance, abs=0.02)


def test_a_robot_does_not_collide_with_itself() -> None:
    model = build_model({"evader": load_robot("nao")}, PhysicsSettings())
    data = mujoco.MjData(model)
    data.qpos[2] = 2.0
    for joint in range(1, model.njnt):
        data.qpos[model.jnt_qposadr[joint]] = model.jnt_range[joint, 0]
    mujoco.mj_forward(model, data)
    assert data.ncon == 0


def test_free_body_is_placed_by_composition() -> None:
    pose = Pose(1.0, 2.0, 0.7)
    placed = transform_free_joint([0.1, -0.2, 0.3, 1.0, 0.0, 0.0, 0.0], pose)
    point = pose.transform_points([[0.1, -0.2]])[0]
    np.testing.assert_allclose(placed[:2], point)
    np.testing.assert_allclose(
        placed[2:], [0.3, np.cos(0.35), 0.0, 0.0, np.sin(0.35)]
    )
