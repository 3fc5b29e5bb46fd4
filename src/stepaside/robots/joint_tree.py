"""Moving links of a robot as arrays, and the loops that place them."""

from collections.abc import Mapping, Sequence
from math import cos, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.compilation import compiled, inlined
from ..core.poses import Array
from ..core.rotations import rotation_about
from .robot_tree import HINGE, LinkFrame, RobotTree


class JointTree(NamedTuple):
    """Links that some joints move: the torso, then parents first.

    Links that they do not move belong to the link that carries them.
    """

    # index of each parent; -1 for the torso, (links,)
    parents: NDArray[np.int64]
    # which of the angles moves each link; -1 for the torso, and for a link at
    # a fixed angle that carries moving ones, (links,)
    columns: NDArray[np.int64]
    # whether each joint is a hinge; else it slides, (links,)
    hinges: NDArray[np.bool_]
    axes: Array  # unit axis of each joint, (links, 3)
    origins: Array  # position of each joint in its parent [m], (links, 3)
    # angle [rad] or length [m] at which a link is parallel to the torso; the
    # fixed angle is subtracted, (links,)
    zeros: Array
    masses: Array  # mass of each link [kg], (links,)
    # mass times CoM in the frame of the link [kg m], (links, 3)
    moments: Array
    carriers: NDArray[np.int64]  # link of each frame, (frames,)
    frame_places: Array  # origin of each frame in its link [m], (frames, 3)
    # axes of each frame in its link, as columns, (frames, 3, 3)
    frame_axes: Array


def joint_tree(
    tree: RobotTree,
    columns: Mapping[str, int],
    fixed: Mapping[str, float],
    frames: Sequence[LinkFrame],
) -> JointTree:
    """Return the links that joints move, given their indices among the angles.

    Other joints are at fixed angles, by default 0; frames are to be placed.
    """
    links = tree.links
    moving = [i for i, link in enumerate(links) if link.joint in columns]
    kept = sorted({0, *(above for i in moving for above in tree.chain(i))})
    number = {link: i for i, link in enumerate(kept)}
    # Link that carries each link, and its axes and place in that one.
    carried: list[tuple[int, Array, Array]] = []
    masses, moments = np.zeros(len(kept)), np.zeros((len(kept), 3))
    for i, link in enumerate(links):
        if i in number:
            carried.append((number[i], np.eye(3), np.zeros(3)))
        else:
            carrier, axes, place = carried[link.parent]
            moved = fixed.get(link.joint, 0.0) - link.zero
            offset = np.array(link.origin)
            if link.kind == HINGE:
                turned = axes @ rotation_about(link.axis, moved)
            else:
                turned, offset = axes, offset + moved * np.array(link.axis)
            carried.append((carrier, turned, place + axes @ offset))
        carrier, axes, place = carried[i]
        masses[carrier] += link.mass
        moments[carrier] += link.mass * (place + axes @ link.com)
    placed = []
    for frame in frames:
        carrier, axes, place = carried[frame.link]
        origin = place + axes @ frame.place
        placed.append((carrier, origin, axes @ np.array(frame.axes)))
    of_kept = [links[i] for i in kept]
    held = {x: angle for x, angle in fixed.items() if x not in columns}
    return JointTree(
        np.array([-1, *(number[x.parent] for x in of_kept[1:])]),
        np.array([columns.get(x.joint, -1) for x in of_kept]),
        np.array([x.kind == HINGE for x in of_kept]),
        np.array([x.axis for x in of_kept]),
        np.array([x.origin for x in of_kept]),
        np.array([x.zero - held.get(x.joint, 0.0) for x in of_kept]),
        masses,
        moments,
        np.array([carrier for carrier, _, _ in placed], dtype=np.int64),
        np.array([origin for _, origin, _ in placed]).reshape(-1, 3),
        np.array([axes for _, _, axes in placed]).reshape(-1, 3, 3),
    )


@compiled
def place_links(
    tree: JointTree,
    angles: Array,
    position: Array,
    heading: float,
    roll: float,
    axes: Array,
    places: Array,
) -> None:
    """Set axes (links, 3, 3) and places (links, 3) of all links, in [m].

    Position, heading and roll are of the torso.
    """
    c, s, cr, sr = cos(heading), sin(heading), cos(roll), sin(roll)
    axes[0, 0, 0], axes[0, 0, 1], axes[0, 0, 2] = c, -s * cr, s * sr
    axes[0, 1, 0], axes[0, 1, 1], axes[0, 1, 2] = s, c * cr, -c * sr
    axes[0, 2, 0], axes[0, 2, 1], axes[0, 2, 2] = 0.0, sr, cr
    for k in range(3):
        places[0, k] = position[k]
    for link in range(1, tree.parents.shape[0]):
        parent = tree.parents[link]
        moved = -tree.zeros[link]
        if tree.columns[link] >= 0:
            moved += angles[tree.columns[link]]
        x, y, z = tree.axes[link, 0], tree.axes[link, 1], tree.axes[link, 2]
        u = tree.origins[link, 0]
        v = tree.origins[link, 1]
        w = tree.origins[link, 2]
        c, s = 1.0, 0.0
        if tree.hinges[link]:
            c, s = cos(moved), sin(moved)
        else:
            u, v, w = u + moved * x, v + moved * y, w + moved * z
        rest = 1.0 - c
        for k in range(3):  # rows of the parent's axes times the rotation
            p, q, r = (
                axes[parent, k, 0],
                axes[parent, k, 1],
                axes[parent, k, 2],
            )
            along = rest * (p * x + q * y + r * z)
            axes[link, k, 0] = c * p + along * x + s * (q * z - r * y)
            axes[link, k, 1] = c * q + along * y + s * (r * x - p * z)
            axes[link, k, 2] = c * r + along * z + s * (p * y - q * x)
            places[link, k] = places[parent, k] + p * u + q * v + r * w


@inlined
def turned(
    axes: Array, link: int, vectors: Array, i: int
) -> tuple[float, float, float]:
    """Return a vector of a link's frame in the frame of the torso's pose."""
    x, y, z = vectors[i, 0], vectors[i, 1], vectors[i, 2]
    return (
        axes[link, 0, 0] * x + axes[link, 0, 1] * y + axes[link, 0, 2] * z,
        axes[link, 1, 0] * x + axes[link, 1, 1] * y + axes[link, 1, 2] * z,
        axes[link, 2, 0] * x + axes[link, 2, 1] * y + axes[link, 2, 2] * z,
    )


@compiled
def place_frame(
    tree: JointTree,
    i: int,
    axes: Array,
    places: Array,
    frame_axes: Array,
    frame_place: Array,
) -> None:
    """Set axes, shape (3, 3), and origin, shape (3,), of a frame."""
    link = tree.carriers[i]
    offset = turned(axes, link, tree.frame_places, i)
    for j in range(3):
        frame_place[j] = places[link, j] + offset[j]
        for k in range(3):
            frame_axes[j, k] = 0.0
            for m in range(3):
                part = axes[link, j, m] * tree.frame_axes[i, m, k]
                frame_axes[j, k] += part


@compiled
def place_frames(
    tree: JointTree,
    angles: Array,
    com: Array,
    frame_places: Array,
    frame_axes: Array,
) -> None:
    """Set the CoM and the poses of all frames in the torso frame, in [m]."""
    links, mass = tree.parents.shape[0], 0.0
    axes, places = np.empty((links, 3, 3)), np.empty((links, 3))
    for k in range(3):
        com[k] = 0.0
    place_links(tree, angles, com, 0.0, 0.0, axes, places)
    for link in range(links):
        moment = turned(axes, link, tree.moments, link)
        mass += tree.masses[link]
        for k in range(3):
            com[k] += moment[k] + tree.masses[link] * places[link, k]
    for k in range(3):
        com[k] /= mass
    for i in range(tree.carriers.shape[0]):
        place_frame(tree, i, axes, places, frame_axes[i], frame_places[i])
