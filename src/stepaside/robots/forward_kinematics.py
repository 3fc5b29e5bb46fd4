"""Where CoM, feet and head are, by the measured joints."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..core.errors import ModelError
from ..core.poses import Array
from .description import REMEDY, RobotDescription
from .expression_tracing import ExpressionTrace, Number
from .jit import Function
from .link_poses import gather_moments, place_links
from .robot_tree import RobotTree
from .tree_cache import load_tree

FEET = 27  # numbers of CoM and feet


class MeasuredPosture(NamedTuple):
    """CoM, feet and head in the torso frame.

    Attributes:
        com: CoM, in [m]. Shape (3,).
        feet: Positions of left and right foot, in [m]. Shape (2, 3).
        frames: Rotations of the foot frames. Shape (2, 3, 3).
        head: Position of the head, in [m], if it was asked for; else that of
            the torso. Shape (3,).
        head_axes: Its axes as columns, likewise. Shape (3, 3).
    """

    com: Array
    feet: Array
    frames: Array
    head: Array = np.zeros(3)
    head_axes: Array = np.eye(3)


class ForwardKinematics:
    """CoM and feet of one robot from the angles of its joints.

    Balance and perception share one: what both ask at one tick is computed
    once.

    Attributes:
        description: The robot.
        tree: Its kinematic tree.
        mass: Its mass, in [kg].
    """

    def __init__(
        self, description: RobotDescription, head: str | None = None
    ) -> None:
        """Open a robot, with the torso at the origin.

        Args:
            description: The robot.
            head: Body that carries its cameras, if they are used.
        """
        self.description = description
        self.tree = tree = load_tree(description)
        self.mass = tree.mass
        feet = (description.left_foot, description.right_foot)
        self._write = _written(
            tree,
            feet,
            head,
            tuple(sorted(description.standing.items())),
        )
        self._feet = [tree.sites[name] for name in feet]
        self._measured = b""
        self._posture: MeasuredPosture

    def posture(self, joint_positions: Array) -> MeasuredPosture:
        """Posture for angles of the actuated joints, in [rad].

        Args:
            joint_positions: Encoders, in [rad]. Shape (joints,).
        """
        measured = joint_positions.tobytes()
        if measured != self._measured:
            numbers = np.array(self._write(*joint_positions.tolist()))
            posture = MeasuredPosture(
                numbers[:3],
                numbers[3:9].reshape(2, 3),
                numbers[9:27].reshape(2, 3, 3),
            )
            if numbers.size > FEET:
                posture = posture._replace(
                    head=numbers[FEET : FEET + 3],
                    head_axes=numbers[FEET + 3 :].reshape(3, 3),
                )
            self._posture = posture
            self._measured = measured
        return self._posture

    def force_sensors(self) -> Array:
        """Places of the foot sensors in the foot frames, in [m].

        Returns:
            Left front-left, front-right, rear-left, rear-right, then right.
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
            off = np.subtract(self.tree.sites[name].place, foot.place)
            corners.append((np.array(foot.axes).T @ off)[:2])
        return np.array(corners)


@lru_cache(maxsize=16)
def _written(
    tree: RobotTree,
    feet: tuple[str, str],
    head: str | None,
    standing: tuple[tuple[str, float], ...],
) -> Function:
    """Write out CoM, and place and axes of feet and head."""
    trace = ExpressionTrace()
    known: dict[str, Number] = dict(standing)
    for i, name in enumerate(tree.motors):
        known[name] = trace.variable(f"q{i}")
    for follower, leader in tree.followers.items():
        known[follower] = known.get(leader, 0.0)
    placed = place_links(tree, [known.get(n, 0.0) for n in tree.joints])
    moments = gather_moments(placed)
    share = 1.0 / moments.masses[0]
    results = [share * moment for moment in moments.firsts[0]]

    frames = [tree.sites[name] for name in feet]
    results += [x for frame in frames for x in placed.place_of(frame)]
    if head is not None:
        frames.append(tree.bodies[head])
    axes = [placed.axes_of(frame) for frame in frames]
    results += [x for rows in axes[:2] for row in rows for x in row]
    if head is not None:
        results += placed.place_of(frames[2])
        results += [x for row in axes[2] for x in row]
    return trace.function("posture", results)
