"""Inverse dynamics of a walking reference: torques of the leg joints.

Links are point masses at their CoM. The ground reaction matches the ZMP of
the plan: a force at the anchor of each foot, and the remaining moment. The
torques follow from the link positions at three consecutive ticks.
"""

import numpy as np
from numpy.typing import NDArray

from ..core.compilation import bound, compiled
from ..core.constants import GRAVITY
from ..core.poses import Array
from .joint_tree import JointTree, place_links, turned
from .leg_kinematics import LegKinematics
from .newton_step import STATE, BodyReference

LIFTED = 1e-6  # height above which a foot carries no load, in [m]


@compiled
def load_rows(
    tree: JointTree,
    motors: NDArray[np.int64],
    rate: float,
    states: Array,
    contacts: Array,
    points: Array,
    calls: int,
    torques: Array,
) -> None:
    """Set the torques (ticks, motors) [N m] of consecutive ticks, 0 before.

    Rows of states begin a tick earlier, points (ticks + 2, links, 3) [m] of
    the masses two ticks; ``rate`` [1/s^2] is of second differences.
    """
    links, n = tree.parents.shape[0], states.shape[1] - STATE
    axes, places = np.empty((links, 3, 3)), np.empty((links, 3))
    forces, moments = np.empty((links, 3)), np.empty((links, 3))
    total, spin = np.empty(3), np.empty(3)
    for tick in range(torques.shape[0]):
        state, contact = states[tick + 1], contacts[tick]
        position, heading, roll = state[n : n + 3], state[n + 3], state[n + 5]
        place_links(tree, state, position, heading, roll, axes, places)
        factor = rate if calls + tick > 1 else 0.0
        for k in range(3):
            total[k], spin[k] = 0.0, 0.0
        for link in range(links):
            mass = tree.masses[link]
            lever = turned(axes, link, tree.moments, link)
            for k in range(3):
                point = places[link, k]
                if mass > 0.0:
                    point += lever[k] / mass
                points[tick + 2, link, k] = point
                change = point - 2.0 * points[tick + 1, link, k]
                change += points[tick, link, k]
                weight = GRAVITY if k == 2 else 0.0
                forces[link, k] = mass * (factor * change + weight)
                total[k] += forces[link, k]
            _set_moment(points[tick + 2, link], forces[link], moments[link])
            for k in range(3):
                spin[k] += moments[link, k]
        for side in range(2):
            # The force acts at the anchor; the moment is that of the ZMP.
            share = contact[6] if side == 0 else 1.0 - contact[6]
            foot, other = 3 * side, 3 - 3 * side
            x = (1.0 - share) * (contact[foot] - contact[other])
            y = (1.0 - share) * (contact[foot + 1] - contact[other + 1])
            z = (1.0 - share) * (contact[foot + 2] - contact[other + 2])
            link = tree.carriers[side]
            for k in range(3):
                forces[link, k] -= share * total[k]
            moments[link, 0] -= share * (spin[0] + y * total[2] - z * total[1])
            moments[link, 1] -= share * (spin[1] + z * total[0] - x * total[2])
            moments[link, 2] -= share * (spin[2] + x * total[1] - y * total[0])
        for link in range(links - 1, 0, -1):
            x, y, z = turned(axes, link, tree.axes, link)
            u, v, w = places[link, 0], places[link, 1], places[link, 2]
            a, b, c = forces[link, 0], forces[link, 1], forces[link, 2]
            torque = x * a + y * b + z * c
            if tree.hinges[link]:
                torque = x * (moments[link, 0] - v * c + w * b)
                torque += y * (moments[link, 1] - w * a + u * c)
                torque += z * (moments[link, 2] - u * b + v * a)
            if motors[link] >= 0:
                torques[tick, motors[link]] += torque
            parent = tree.parents[link]
            for k in range(3):
                forces[parent, k] += forces[link, k]
                moments[parent, k] += moments[link, k]


@compiled
def _set_moment(point: Array, force: Array, moment: Array) -> None:
    """Set the moment of a force about the origin."""
    moment[0] = point[1] * force[2] - point[2] * force[1]
    moment[1] = point[2] * force[0] - point[0] * force[2]
    moment[2] = point[0] * force[1] - point[1] * force[0]


class LegLoads:
    """Torques of the leg joints of one robot that tracks a reference."""

    def __init__(
        self, kinematics: LegKinematics, *, zmp_forward: float, tick: float
    ) -> None:
        """Prepare loads of feet anchored at ``zmp_forward`` in their frame."""
        self._kinematics, self._zmp_forward = kinematics, zmp_forward
        names, links = kinematics.joint_names, kinematics.links
        motors = np.array([names.index(name) for name in kinematics.free])
        motors = np.where(links.columns < 0, -1, motors[links.columns])
        # Mass positions two ticks ago and one tick ago, then of the last rows.
        self._points = np.zeros((2, len(motors), 3))
        rows = self._points[0]
        self._load = bound(
            *(load_rows, links, motors, 1.0 / (tick * tick)),
            more=(rows, rows, self._points, 0, rows),
        )
        self._calls = 0

    def torques(
        self, reference: BodyReference, zmp: tuple[float, float]
    ) -> Array:
        """Return the torques of all motors, in [N m], once a tick.

        Accelerations are second differences of the last three postures,
        and zero in the first two calls.
        """
        states = np.array([self._kinematics.state] * 2)
        row = np.array([reference.row()])
        torques: Array = self.torque_rows(states, row, np.array([zmp]))[0]
        return torques

    def torque_rows(
        self, states: Array, references: Array, zmp: Array
    ) -> Array:
        """Return the torques of consecutive ticks, as :meth:`torques` does.

        States are :class:`.LegStates`, references rows of the body
        reference, and ``zmp`` (ticks, 2) [m] is that of the plan.
        """
        ticks = len(references)
        points = np.empty((ticks + 2, *self._points.shape[1:]))
        points[:2] = self._points[-2:]
        contacts = self._ground_contacts(references, zmp)
        torques = np.zeros((ticks, len(self._kinematics.joint_names)))
        self._load(states, contacts, points, self._calls, torques)
        self._points = points
        self._calls += ticks
        return torques

    def rewind(self, ticks: int) -> None:
        """Return to the state after the first ``ticks`` of the last rows."""
        self._calls -= len(self._points) - 2 - ticks
        self._points = self._points[ticks : ticks + 2]

    def _ground_contacts(self, references: Array, zmp: Array) -> Array:
        """Return anchors of both feet [m] and load fraction of the left."""
        x, y, z, yaw, u, v, w, turned = references[:, 3:11].T
        forward = self._zmp_forward
        x, y = x + forward * np.cos(yaw), y + forward * np.sin(yaw)
        u, v = u + forward * np.cos(turned), v + forward * np.sin(turned)
        fraction = (zmp[:, 0] - u) * (x - u) + (zmp[:, 1] - v) * (y - v)
        fraction /= (x - u) * (x - u) + (y - v) * (y - v)
        fraction = np.where(fraction < 0.0, 0.0, fraction)
        fraction = np.where(fraction > 1.0, 1.0, fraction)
        fraction = np.where(w > LIFTED, 1.0, fraction)
        fraction = np.where(z > LIFTED, 0.0, fraction)
        return np.column_stack([x, y, z, u, v, w, fraction])
