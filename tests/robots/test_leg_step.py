"""Test the steps of legs of any robot: rows, redundancy, refusals."""

from functools import cache
from pathlib import Path
from tempfile import mkdtemp

import mujoco
import numpy as np
import pytest

from stepaside.core.errors import ReachError
from stepaside.core.poses import Array
from stepaside.robots.description import RobotDescription, load_robot
from stepaside.robots.joint_tree import joint_tree
from stepaside.robots.leg_kinematics import BodyReference, LegKinematics
from stepaside.robots.newton_step import linearise, move_within
from stepaside.robots.tree_cache import load_tree
from stored_values import compare_stored, summed
from synthetic_humanoid import synthetic_humanoid

NAO = load_robot("nao")
TICK = 0.004
ROBOTS = ["nao", "synthetic", "seven"]
STANCE = BodyReference(
    (0.03, 0.0, 0.6), (0.02, 0.1, 0.0, 0.1), (-0.02, -0.1, 0.0, -0.05)
)


@cache
def robot(name: str) -> RobotDescription:
    if name == "nao":
        return NAO
    return synthetic_humanoid(Path(mkdtemp()), twists=name == "seven")


@pytest.mark.parametrize("roll", [0.0, 0.2])
@pytest.mark.parametrize("name", ROBOTS)
def test_the_rows_are_the_derivative_of_their_errors(
    name: str, roll: float
) -> None:
    """By central differences in every unknown, joints that slide included.

    All joints move here, those of head and arms, too; the errors of rotation
    are those of a level sole.
    """
    description = robot(name)
    tree = load_tree(description)
    columns = {joint: i for i, joint in enumerate(tree.joints)}
    soles = [
        tree.sites[description.left_foot],
        tree.sites[description.right_foot],
    ]
    if name != "nao":
        soles[1] = tree.sites["eye"]  # on a mast, which slides
    links, count = joint_tree(tree, columns, {}, soles), len(columns)
    random = np.random.default_rng(5)
    state = np.zeros(count + 6)
    state[: count + 4] = random.uniform(-0.3, 0.3, count + 4)
    rows = 16
    errors, jacobian = np.empty(rows), np.empty((rows, count + 4))

    def errors_at(reference: Array, at: Array) -> Array:
        found = np.empty(rows)
        unused = np.empty_like(jacobian)
        linearise(links, reference, at, roll, found, unused)
        return found

    reference = random.uniform(-0.3, 0.3, 15)
    linearise(links, reference, state, roll, errors, jacobian)
    changes = np.eye(count + 6)[: count + 4]
    for unknown, change in enumerate(changes):
        ahead, behind = (
            errors_at(reference, state + h * change) for h in (1e-6, -1e-6)
        )
        slope = (behind - ahead) / 2e-6
        for part in (slice(0, 3), slice(6, 9), slice(12, 15)):
            np.testing.assert_allclose(
                slope[part], jacobian[part, unknown], atol=1e-7
            )
    np.testing.assert_array_equal(jacobian[15, :-1], 0.0)
    assert jacobian[15, -1] == 1.0


@pytest.mark.parametrize("name", ROBOTS)
def test_steps_converge_to_feet_and_com_in_mujoco_s_eyes(name: str) -> None:
    """Six joints a leg, seven, or two of eleven that share a motor."""
    description = robot(name)
    legs = LegKinematics(description, tick=TICK)
    stance = STANCE
    if name == "nao":
        stance = BodyReference(
            *((0.01, 0.0, 0.26), (0.01, 0.05, 0.0, 0.1)),
            (-0.01, -0.05, 0.0, -0.05),
        )
    targets = legs.stand(stance)
    assert targets.size == len(legs.joint_names)
    x, y, z = stance.com
    near = stance._replace(com=(x + 1e-3, y + 1e-3, z - 1e-3))
    sizes = []
    for _ in range(6):
        legs.track(near)
        sizes.append(float(np.abs(legs.error).max()))
    assert sizes[0] == pytest.approx(1e-3, rel=0.1)
    assert sizes[1] < 0.03 * sizes[0] and sizes[2] < 0.03 * sizes[1]
    assert sizes[-1] < 1e-12
    model = description.compile()
    data = mujoco.MjData(model)
    data.qpos[: legs.posture.size] = legs.posture
    mujoco.mj_forward(model, data)
    torso = data.body(description.torso).id
    assert data.subtree_com[torso] == pytest.approx(near.com, abs=1e-9)
    for site, foot in (
        (description.left_foot, near.left_foot),
        (description.right_foot, near.right_foot),
    ):
        assert data.site(site).xpos == pytest.approx(foot[:3], abs=1e-9)
        axes = data.site(site).xmat.reshape(3, 3)
        assert np.arctan2(axes[1, 0], axes[0, 0]) == pytest.approx(foot[3])
        assert axes[2, 2] == pytest.approx(1.0)


def test_mirrored_references_have_mirrored_targets() -> None:
    left, right = (0.01, 0.05, 0.0, 0.1), (-0.02, -0.05, 0.01, -0.04)
    found = []
    for side in (1.0, -1.0):
        one, other = left, right
        if side < 0.0:
            one, other = ((x, -y, z, -yaw) for x, y, z, yaw in (right, left))
        tilts = (0.01, 0.02), (-0.02, 0.01)
        if side < 0.0:
            tilts = (0.02, 0.01), (-0.01, 0.02)
        asked = BodyReference((0.02, 0.01 * side, 0.26), one, other, *tilts)
        legs = LegKinematics(NAO, tick=TICK)
        legs.stand(asked)
        for _ in range(5):
            targets = legs.track(asked)
        found.append(dict(zip(legs.joint_names, targets, strict=True)))
    first, second = found
    assert first["LHipRoll"] != pytest.approx(second["LHipRoll"], abs=1e-3)
    for name in NAO.legs:
        if "YawPitch" not in name:  # it is one of both legs
            twin = {"L": "R", "R": "L"}[name[0]] + name[1:]
            sign = -1.0 if "Roll" in name else 1.0
            assert second[twin] == pytest.approx(sign * first[name], abs=1e-6)


def test_nan_and_inf_in_a_reference_are_refused() -> None:
    legs = LegKinematics(NAO, tick=TICK)
    stance = BodyReference(
        (0.02, 0.0, 0.26), (0.0, 0.05, 0.0, 0.0), (0.0, -0.05, 0.0, 0.0)
    )
    legs.stand(stance)
    with pytest.raises(ReachError, match="off by nan"):
        legs.track(stance._replace(com=(float("nan"), 0.0, 0.26)))


def bounded(error: tuple[float, ...]) -> Array:
    """Two joints that lift the torso together, and a row for each unknown.

    Returns:
        Moves of both joints, then of the torso.
    """
    jacobian = np.roll(np.eye(6), 2, axis=1)  # rows of the torso first
    jacobian[2, :2] = 1.0
    limits = np.array([(-1.0, 1.0, 1.0, 0.1)] * 2)
    step = np.empty(6)
    move_within(
        *(jacobian, np.array(error, float), np.zeros(8), limits),
        *(np.empty((6, 6)), step),
    )
    return step


def test_other_joints_are_optimal_with_one_at_its_limit() -> None:
    """The torso moves as far as it then has to, not as if it had moved."""
    move = bounded((0, 0, 0.2, 0, 0.3, 0.02))
    assert move == pytest.approx([0.1, 0.02, 0, 0, 0.08, 0])
    move = bounded((0, 0, 0.2, 0, 0.3, -0.4))
    assert move == pytest.approx([0.1, -0.1, 0, 0, 0.2, 0])


@pytest.mark.parametrize("size", [0.002, 0.03])
@pytest.mark.parametrize("name", ROBOTS)
def test_random_references_are_followed_as_stored(
    name: str, size: float
) -> None:
    """Within reach and beyond, where joints stop at their limits."""
    draw, made = np.random.default_rng(7), robot(name)
    legs, found = LegKinematics(made, tick=TICK), []
    stance = STANCE if name != "nao" else STANCE._replace(com=(0.01, 0, 0.26))
    stance = stance._replace(
        left_foot=(0.01, 0.05, 0, 0.1), right_foot=(-0.01, -0.05, 0, -0.05)
    )
    legs.stand(stance)
    row = np.array(stance.row())
    for _ in range(120):
        goal = BodyReference.from_row(
            (row + draw.normal(0, size, row.size)).tolist()
        )
        try:
            found += [legs.track(goal), legs.torso_heading]
        except ReachError as error:
            found.append(str(error))
            legs.stand(stance)
    key = f"legs, {name}, {size}"
    compare_stored("numbers.json", key, summed(found), 1e-5)
