"""Forward kinematics of CoM, feet and head from measured joint angles."""

from typing import NamedTuple

import numpy as np

from ..core.compilation import bound
from ..core.errors import ModelError
from ..core.poses import Array
from .description import REMEDY, RobotDescription
from .joint_tree import joint_tree, place_frames
from .tree_cache import load_tree


class MeasuredPosture(NamedTuple):
    """CoM, feet and head in the torso frame.

    Attributes:
        position_com_in_torso: Position of the CoM, in [m]. Shape (3,).
        positions_feet_in_torso: Positions of left and right foot, in [m].
            Shape (2, 3).
        axes_feet_in_torso: Rotation matrices of both. Shape (2, 3, 3).
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
        angles: Angles of the actuated joints, in [rad]. Shape (joints,).
        com: CoM at these angles in the torso frame, in [m]. Shape (3,).
        places: Positions of left foot, right foot and head, if that is
            known, in [m]. Shape (2 or 3, 3).
        axes: Their axes as columns. Shape (2 or 3, 3, 3).
        run: Function that sets the results at :attr:`angles`.
    """

    def __init__(
        self, description: RobotDescription, head: str | None = None
    ) -> None:
        """Load the kinematic tree.

        The head is the body that carries the cameras; None leaves it out.
        """
        self.description = description
        self.tree = tree = load_tree(description)
        self.mass = tree.mass
        feet = (description.left_foot, description.right_foot)
        self._feet = frames = [tree.sites[name] for name in feet]
        if head is not None:
            frames = [*frames, tree.bodies[head]]
        columns = {name: i for i, name in enumerate(tree.motors)}
        fixed = {k: float(v) for k, v in description.standing.items()}
        for follower, leader in tree.followers.items():
            if leader in columns:
                columns[follower] = columns[leader]
            else:
                fixed[follower] = fixed.get(leader, 0.0)
        self.angles = np.zeros(len(tree.motors))
        self.com = np.empty(3)
        self.places = np.empty((len(frames), 3))
        self.axes = np.empty((len(frames), 3, 3))
        self.run = bound(
            *(place_frames, joint_tree(tree, columns, fixed, frames)),
            *(self.angles, self.com, self.places, self.axes),
        )
        self._cache_key = b""
        self._posture: MeasuredPosture

    def posture(self, joint_positions: Array) -> MeasuredPosture:
        """Return the posture at angles of the actuated joints, in [rad]."""
        key = joint_positions.tobytes()
        if key != self._cache_key:
            self.evaluate(joint_positions)
            places, axes = self.places.copy(), self.axes.copy()
            self._posture = MeasuredPosture(
                *(self.com.copy(), places[:2], axes[:2]),
                *((places[2], axes[2]) if len(places) > 2 else ()),
            )
            self._cache_key = key
        return self._posture

    def evaluate(self, angles: Array) -> None:
        """Set the results at angles, in [rad]."""
        self.angles[:] = angles
        self.run()

    def force_sensors(self) -> Array:
        """Return the positions of the foot force sensors. Shape (8, 2).

        They are (x, y) in the foot frame, in [m]: front left, front right,
        rear left, rear right of the left foot, then of the right foot.
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
