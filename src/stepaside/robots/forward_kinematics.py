"""Forward kinematics of CoM, feet and head from measured joint angles."""

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..core.compilation import bound
from ..core.errors import ModelError
from ..core.poses import Array
from .description import REMEDY, RobotDescription
from .expression_tracing import ExpressionTrace, Number
from .link_poses import gather_moments, place_links
from .robot_tree import RobotTree
from .tree_cache import load_tree

LOOP = """\
def posture_row(angles, numbers):
    found = posture({})
    for i in range(numbers.shape[0]):
        numbers[i] = found[i]
"""
HEAD_OFFSET = 27  # index of the head in the results: after CoM and feet


class MeasuredPosture(NamedTuple):
    """CoM, feet and head in the torso frame.

    Attributes:
        position_com_in_torso: Position of the CoM, in [m]. Shape (3,).
        positions_feet_in_torso: Positions of left and right foot, in [m].
            Shape (2, 3).
        axes_feet_in_torso: Rotation matrices of left and right foot. Shape (2,
            3, 3).
        position_head_in_torso: Position of the head, in [m]; zero without a
            head. Shape (3,).
        axes_head_in_torso: Rotation matrix of the head; identity without a
            head. Shape (3, 3).
    """

    position_com_in_torso: Array
    positions_feet_in_torso: Array
    axes_feet_in_torso: Array
    position_head_in_torso: Array = np.zeros(3)
    axes_head_in_torso: Array = np.eye(3)


class ForwardKinematics:
    """Forward kinematics of one robot.

    The last result is cached, so that balance control and perception can
    share one object at no extra cost.

    Attributes:
        description: Robot description.
        tree: Kinematic tree of the robot.
        mass: Mass of the robot, in [kg].
        angles: Arguments of the compiled formulas: angles of the actuated
            joints, in [rad]. Shape (joints,).
        numbers: Their results: position of the CoM, positions, then rotation
            matrices of the feet, by rows; then those of the head.
        run: Function that evaluates the formulas.
    """

    def __init__(
        self, description: RobotDescription, head: str | None = None
    ) -> None:
        """Load the kinematic tree and generate its formulas.

        Args:
            description: Robot description.
            head: Body that carries the cameras; None to leave out the head.
        """
        self.description = description
        self.tree = tree = load_tree(description)
        self.mass = tree.mass
        feet = (description.left_foot, description.right_foot)
        standing = tuple(sorted(description.standing.items()))
        posture_row = _trace_posture(tree, feet, head, standing)
        self.numbers = np.empty(HEAD_OFFSET + (0 if head is None else 12))
        self.angles = np.empty(len(tree.motors))
        self.run = bound(posture_row, self.angles, self.numbers)
        self._feet = [tree.sites[name] for name in feet]
        self._cache_key = b""
        self._posture: MeasuredPosture

    def posture(self, joint_positions: Array) -> MeasuredPosture:
        """Return the posture at measured joint angles.

        Args:
            joint_positions: Angles of the actuated joints, in [rad].
                Shape (joints,).
        """
        key = joint_positions.tobytes()
        if key != self._cache_key:
            self.evaluate(joint_positions)
            numbers = self.numbers.copy()
            posture = MeasuredPosture(
                numbers[:3],
                numbers[3:9].reshape(2, 3),
                numbers[9:27].reshape(2, 3, 3),
            )
            if numbers.size > HEAD_OFFSET:
                posture = posture._replace(
                    position_head_in_torso=numbers[
                        HEAD_OFFSET : HEAD_OFFSET + 3
                    ],
                    axes_head_in_torso=numbers[HEAD_OFFSET + 3 :].reshape(
                        3, 3
                    ),
                )
            self._posture = posture
            self._cache_key = key
        return self._posture

    def evaluate(self, angles: Array) -> None:
        """Set :attr:`numbers` to the results at angles, in [rad]."""
        self.angles[:] = angles
        self.run()

    def force_sensors(self) -> Array:
        """Return the positions of the foot force sensors.

        Returns:
            (x, y) in the foot frame, in [m]: front left, front right, rear
            left, rear right of the left foot, then of the right foot.
            Shape (8, 2).

        Raises:
            ModelError: If the robot lacks one.
        """
        corners = []
        for i, name in enumerate(self.description.sensors.feet):
            foot = self._feet[i // 4]
            if name not in self.tree.sites:
                raise ModelError(
                    f"{self.description.name} needs a site {name!r} with a "
                    f"touch sensor under a foot; {REMEDY}"
                )
            offset = np.subtract(self.tree.sites[name].place, foot.place)
            corners.append((np.array(foot.axes).T @ offset)[:2])
        return np.array(corners)


@lru_cache(maxsize=16)
def _trace_posture(
    tree: RobotTree,
    feet: tuple[str, str],
    head: str | None,
    standing: tuple[tuple[str, float], ...],
) -> Callable[[Array, Array], None]:
    """Generate the formulas of CoM, feet and head.

    Args:
        tree: Kinematic tree.
        feet: Sites of the soles, left and right.
        head: Body that carries the cameras, if any.
        standing: Angles of joints without a motor, by name, in [rad].
    """
    trace = ExpressionTrace()
    angles: dict[str, Number] = dict(standing)
    for i, name in enumerate(tree.motors):
        angles[name] = trace.variable(f"q{i}")
    for follower, leader in tree.followers.items():
        angles[follower] = angles.get(leader, 0.0)
    links = place_links(tree, [angles.get(n, 0.0) for n in tree.joints])
    moments = gather_moments(links)
    inverse_mass = 1.0 / moments.masses[0]
    results = [inverse_mass * moment for moment in moments.firsts[0]]

    frames = [tree.sites[name] for name in feet]
    results += [x for frame in frames for x in links.position_of(frame)]
    if head is not None:
        frames.append(tree.bodies[head])
    axes = [links.axes_of(frame) for frame in frames]
    results += [x for rows in axes[:2] for row in rows for x in row]
    if head is not None:
        results += links.position_of(frames[2])
        results += [x for row in axes[2] for x in row]
    formula = trace.formula("posture", results)
    arguments = ", ".join(f"angles[{i}]" for i in range(len(tree.motors)))
    run: Callable[[Array, Array], None] = formula.loop(
        "posture_row", LOOP.format(arguments)
    )
    return run
