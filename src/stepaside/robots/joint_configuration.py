"""Joint configuration of a robot: frames, CoM and Jacobians."""

import numpy as np

from ..core.errors import ModelError
from ..core.poses import Array
from .joint_tree import joint_tree, place_links
from .robot_tree import HINGE, LinkFrame, RobotTree


class Configuration:
    """Joint angles and torso pose of one robot, with derived quantities.

    An immutable value for any frame of any robot, not optimised for speed.

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
        links = len(tree.links)
        axes, places = np.empty((links, 3, 3)), np.empty((links, 3))
        columns = {name: i for i, name in enumerate(tree.joints)}
        moved = joint_tree(tree, columns, {}, [])
        place_links(moved, self.joints, np.zeros(3), 0.0, 0.0, axes, places)
        self._axes = self.axes @ axes
        self._places = self.place + places @ self.axes.T
        for values in (self.joints, self.place, self.axes):
            values.setflags(write=False)
        self._masses = [link.mass for link in tree.links]
        self._coms = [
            self._places[i] + self._axes[i] @ link.com
            for i, link in enumerate(tree.links)
        ]

    @property
    def com(self) -> Array:
        """CoM of the robot in the world, in [m]. Shape (3,)."""
        return np.average(self._coms, axis=0, weights=self._masses)

    def body_in_world(self, name: str) -> tuple[Array, Array]:
        """Return the origin of a body, in [m], and its axes as columns."""
        return self._pose_of(self._find("body", name))

    def site_in_world(self, name: str) -> tuple[Array, Array]:
        """Return the origin of a site, in [m], and its axes as columns."""
        return self._pose_of(self._find("site", name))

    def jacobian_of_site(self, name: str) -> Array:
        """Return the Jacobian of a site in the world.

        Returns:
            Rows: velocity [m/s], then angular velocity [rad/s] of the site.
            Columns: velocity and angular velocity of the torso in the world,
            then velocities of all joints. Shape (6, 6 + joints).
        """
        frame = self._find("site", name)
        return self._jacobian(frame.link, self._pose_of(frame)[0])

    def jacobian_of_com(self) -> Array:
        """Return the Jacobian of the CoM in the world.

        Returns:
            Rows: velocity of the CoM, in [m/s]. Columns as those of
            :meth:`jacobian_of_site`. Shape (3, 6 + joints).
        """
        masses = [link.mass for link in self.tree.links]
        rows = [self._jacobian(i, com)[:3] for i, com in enumerate(self._coms)]
        return np.average(rows, axis=0, weights=masses)

    def _jacobian(self, link: int, point: Array) -> Array:
        """Return the Jacobian of a point of a link. Shape (6, 6 + joints)."""
        rows = np.zeros((6, 6 + len(self.tree.joints)))
        rows[:, :6] = np.eye(6)
        rows[:3, 3:6] = np.cross(np.eye(3), point - self.place).T
        for moved in self.tree.chain(link):
            axis = self._axes[moved] @ self.tree.links[moved].axis
            if self.tree.links[moved].kind == HINGE:
                lever = point - self._places[moved]
                rows[:3, 5 + moved] = np.cross(axis, lever)
                rows[3:, 5 + moved] = axis
            else:
                rows[:3, 5 + moved] = axis
        return rows

    def _find(self, kind: str, name: str) -> LinkFrame:
        frames = self.tree.bodies if kind == "body" else self.tree.sites
        if name not in frames:
            raise ModelError(
                f"there is no {kind} {name!r}; there are "
                f"{', '.join(sorted(frames))}"
            )
        return frames[name]

    def _pose_of(self, frame: LinkFrame) -> tuple[Array, Array]:
        place, axes = self._places[frame.link], self._axes[frame.link]
        return place + axes @ frame.place, axes @ np.array(frame.axes)
