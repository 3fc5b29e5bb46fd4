"""Joint configuration of a robot: frames, CoM and Jacobians, in NumPy."""

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
    """Joint angles and torso pose of one robot, with derived quantities.

    An immutable value for any frame of any robot, not optimised for speed;
    real-time control uses the generated formulas of :mod:`.ik_step` and
    :mod:`.forward_kinematics`.

    Attributes:
        tree: Kinematic tree of the robot.
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
        """Make a configuration; by default with the torso at the origin.

        Raises:
            ModelError: If the number of angles differs from that of joints.
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

    @cached_property
    def _links(self) -> LinkPoses:
        return place_links(self.tree, self.joints.tolist())

    @cached_property
    def _moments(self) -> MassMoments:
        return gather_moments(self._links)

    @property
    def com(self) -> Array:
        """CoM of the robot in the world, in [m]. Shape (3,)."""
        first = np.array(self._moments.firsts[0], dtype=np.float64)
        return self._to_world(first / self._moments.masses[0])

    def position_body_in_world(self, name: str) -> Array:
        """Return the origin of a body in the world, in [m]. Shape (3,)."""
        return self._position_of(self._find("body", name))

    def axes_body_in_world(self, name: str) -> Array:
        """Return the axes of a body in the world. Shape (3, 3)."""
        return self._axes_of(self._find("body", name))

    def position_site_in_world(self, name: str) -> Array:
        """Return the origin of a site in the world, in [m]. Shape (3,)."""
        return self._position_of(self._find("site", name))

    def axes_site_in_world(self, name: str) -> Array:
        """Return the axes of a site in the world. Shape (3, 3)."""
        return self._axes_of(self._find("site", name))

    def jacobian_of_site(self, name: str) -> Array:
        """Return the Jacobian of a site in the world.

        Returns:
            Rows: velocity [m/s], then angular velocity [rad/s] of the site.
            Columns: velocity and angular velocity of the torso in the world,
            then velocities of all joints. Shape (6, 6 + joints).
        """
        frame = self._find("site", name)
        point = self._links.position_of(frame)
        rows = np.zeros((6, 6 + len(self.tree.joints)))
        rows[:, :6] = np.eye(6)
        rows[:3, 3:6] = _lever_matrix(self._position_of(frame) - self.place)
        for link in self.tree.chain(frame.link):
            motion = motion_of(self._links, self._moments, link, point)
            rows[:3, 5 + link] = self.axes @ np.array(motion.linear)
            rows[3:, 5 + link] = self.axes @ np.array(motion.angular)
        return rows

    def jacobian_of_com(self) -> Array:
        """Return the Jacobian of the CoM in the world.

        Returns:
            Rows: velocity of the CoM, in [m/s]. Columns as those of
            :meth:`jacobian_of_site`. Shape (3, 6 + joints).
        """
        rows = np.zeros((3, 6 + len(self.tree.joints)))
        rows[:, :3] = np.eye(3)
        rows[:, 3:6] = _lever_matrix(self.com - self.place)
        mass = self._moments.masses[0]
        origin = (0.0, 0.0, 0.0)
        for link in range(1, len(self.tree.links)):
            motion = motion_of(self._links, self._moments, link, origin)
            rows[:, 5 + link] = self.axes @ np.array(motion.moment) / mass
        return rows

    def _find(self, kind: str, name: str) -> LinkFrame:
        frames = self.tree.bodies if kind == "body" else self.tree.sites
        if name not in frames:
            raise ModelError(
                f"there is no {kind} {name!r}; there are "
                f"{', '.join(sorted(frames))}"
            )
        return frames[name]

    def _to_world(self, point: Array) -> Array:
        in_world: Array = self.place + self.axes @ point
        return in_world

    def _position_of(self, frame: LinkFrame) -> Array:
        position = self._links.position_of(frame)
        return self._to_world(np.array(position, dtype=np.float64))

    def _axes_of(self, frame: LinkFrame) -> Array:
        axes = np.array(self._links.axes_of(frame), dtype=np.float64)
        in_world: Array = self.axes @ axes
        return in_world


def _lever_matrix(lever: Array) -> Array:
    """Return the matrix M with M w = w x lever. Shape (3, 3)."""
    x, y, z = lever
    return np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
