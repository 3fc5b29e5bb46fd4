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
    """CoM, feet and head in the torso frame."""

    position_com_in_torso: Array  # position of the CoM [m], (3,)
    # positions of left and right foot [m], (2, 3)
    positions_feet_in_torso: Array
    axes_feet_in_torso: Array  # rotation matrices of both, (2, 3, 3)
    # position of the head [m]; zero without a head, (3,)
    position_head_in_torso: Array = np.zeros(3)
    # rotation matrix of the head; identity without a head, (3, 3)
    axes_head_in_torso: Array = np.eye(3)


class ForwardKinematics:
    """Kinematics of the actuated joints: CoM, left foot, right foot and head.

    Results are in the torso frame, in [m], with axes as columns. The last one
    is cached for balance control and perception.
    """

    def __init__(
        self, description: RobotDescription, head: str | None = None
    ) -> None:
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
        """Return positions (8, 2) [m] of force sensors in the foot frames."""
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
