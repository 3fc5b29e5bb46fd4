"""A robot in one posture: transforms, CoM and Jacobians, in NumPy."""

from collections.abc import Mapping
from functools import cached_property

import numpy as np

from ..core.errors import ModelError
from ..core.poses import Array
from .link_poses import (
    LinkPoses,
    MassMoments,
    gather_moments,
    motion_of,
    place_links,
)
from .robot_tree import LinkFrame, RobotTree


class Configuration:
    """Joint angles and torso pose of one robot, and what follows from them.

    A value: to move, make another one. It is made for any frame and any
    robot, not for speed; what control needs at every tick is written out in
    :mod:`.leg_step` and :mod:`.forward`.

    Attributes:
        tree: The robot.
        joints: Angles of all joints in the order of ``tree.joints``, in
            [rad], or [m] for slides. Shape (joints,).
        place: Origin of the torso in the world, in [m]. Shape (3,).
        axes: Axes of the torso in the world, as columns. Shape (3, 3).
    """

    def __init__(
        self,
        tree: RobotTree,
        joints: Array,
        place: Array | None = None,
        axes: Array | None = None,
    ) -> None:
        """Take a posture; by default with the torso at the origin.

        Raises:
            ModelError: If there are not as many angles as joints.
        """
        if len(joints) != len(tree.joints):
            raise ModelError(
                f"joints must be {len(tree.joints)} angles, got {len(joints)}"
            )
        self.tree = tree
        self.joints = np.array(joints, dtype=np.float64)
        self.place = np.zeros(3) if place is None else np.array(place)
        self.axes = np.eye(3) if axes is None else np.array(axes)
        for values in (self.joints, self.place, self.axes):
            values.setflags(write=False)

    @classmethod
    def of_motors(
        cls, tree: RobotTree, angles: Array, standing: Mapping[str, float]
    ) -> "Configuration":
        """Posture of actuated joints, whose followers follow.

        Args:
            tree: The robot.
            angles: In the order of ``tree.motors``, in [rad].
            standing: Angles of joints without a motor; 0 by default.
        """
        known = dict(standing)
        known.update(
            zip(tree.motors, np.asarray(angles).tolist(), strict=True)
        )
        for follower, leader in tree.followers.items():
            known[follower] = known.get(leader, 0.0)
        joints = [known.get(name, 0.0) for name in tree.joints]
        return cls(tree, np.array(joints))

    @cached_property
    def _links(self) -> LinkPoses:
        return place_links(self.tree, self.joints.tolist())

    @cached_property
    def _moments(self) -> MassMoments:
        return gather_moments(self._links)

    @property
    def com(self) -> Array:
        """CoM of the robot in the world, in [m]. Shape (3,)."""
        return self._seen(self._com_of_torso)

    @property
    def _com_of_torso(self) -> Array:
        first = np.array(self._moments.firsts[0], dtype=np.float64)
        return first / self._moments.masses[0]

    def place_of_body(self, name: str) -> Array:
        """Origin of a body in the world, in [m]. Shape (3,)."""
        return self._place_of(self._find("body", name))

    def axes_of_body(self, name: str) -> Array:
        """Axes of a body in the world, as columns. Shape (3, 3)."""
        return self._axes_of(self._find("body", name))

    def place_of_site(self, name: str) -> Array:
        """Origin of a site in the world, in [m]. Shape (3,)."""
        return self._place_of(self._find("site", name))

    def axes_of_site(self, name: str) -> Array:
        """Axes of a site in the world, as columns. Shape (3, 3)."""
        return self._axes_of(self._find("site", name))

    def jacobian_of_site(self, name: str) -> Array:
        """Velocity and angular velocity of a site, by what moves it.

        Returns:
            Rows of the velocity [m/s], then of the angular velocity
            [rad/s], in the world; columns of the torso's velocity and
            angular velocity in the world, then of all joints.
            Shape (6, 6 + joints).
        """
        frame = self._find("site", name)
        point = self._links.place_of(frame)
        rows = np.zeros((6, 6 + len(self.tree.joints)))
        rows[:, :6] = np.eye(6)
        rows[:3, 3:6] = _spin(self._place_of(frame) - self.place)
        for link in self.tree.chain(frame.link):
            found = motion_of(self._links, self._moments, link, point)
            rows[:3, 5 + link] = self.axes @ np.array(found.linear)
            rows[3:, 5 + link] = self.axes @ np.array(found.angular)
        return rows

    def jacobian_of_com(self) -> Array:
        """Velocity of the CoM by what moves it; columns likewise.

        Returns:
            In [m/s], in the world. Shape (3, 6 + joints).
        """
        rows = np.zeros((3, 6 + len(self.tree.joints)))
        rows[:, :3] = np.eye(3)
        rows[:, 3:6] = _spin(self.com - self.place)
        mass = self._moments.masses[0]
        origin = (0.0, 0.0, 0.0)
        for link in range(1, len(self.tree.links)):
            found = motion_of(self._links, self._moments, link, origin)
            rows[:, 5 + link] = self.axes @ np.array(found.moment) / mass
        return rows

    def _find(self, kind: str, name: str) -> LinkFrame:
        known = self.tree.bodies if kind == "body" else self.tree.sites
        if name not in known:
            raise ModelError(
                f"there is no {kind} {name!r}; there are "
                f"{', '.join(sorted(known))}"
            )
        return known[name]

    def _seen(self, place: Array) -> Array:
        seen: Array = self.place + self.axes @ place
        return seen

    def _place_of(self, frame: LinkFrame) -> Array:
        place = self._links.place_of(frame)
        return self._seen(np.array(place, dtype=np.float64))

    def _axes_of(self, frame: LinkFrame) -> Array:
        axes = np.array(self._links.axes_of(frame), dtype=np.float64)
        seen: Array = self.axes @ axes
        return seen


def _spin(lever: Array) -> Array:
    """Velocity of the end of a lever by angular velocity. Shape (3, 3)."""
    x, y, z = lever
    return np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
