"""The kinematic tree of a robot, as plain numbers.

Links hang on joints that turn or slide. Every link has its frame on its
joint; in the zero posture all of these frames are parallel to the torso's.
What is welded together is one link.
"""

import json
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

from ..core.brief_repr import brief_repr
from ..core.errors import ModelError

HINGE, SLIDE = "hinge", "slide"
Triple = tuple[float, float, float]


class Link(NamedTuple):
    """A link and the joint that moves it.

    Attributes:
        joint: Name of the joint; empty for the torso.
        parent: Number of the link that it hangs on; -1 for the torso.
        kind: ``hinge`` or ``slide``.
        axis: Unit axis of the joint, in the link's frame.
        origin: Place of the joint in the parent's frame, in [m].
        zero: Angle [rad] or length [m] in the zero posture.
        low: Least angle or length.
        high: Greatest one.
        mass: Mass of the link, in [kg].
        com: Its CoM in its frame, in [m].
    """

    joint: str
    parent: int
    kind: str
    axis: Triple
    origin: Triple
    zero: float
    low: float
    high: float
    mass: float
    com: Triple


class Servo(NamedTuple):
    """What holds an actuated joint at its target.

    Attributes:
        stiffness: Torque by angle, in [N m/rad]; 0 if it is no position
            servo.
        damping: Torque by speed, in [N m s/rad].
    """

    stiffness: float
    damping: float


class LinkFrame(NamedTuple):
    """A frame that is fixed to a link.

    Attributes:
        link: Number of the link.
        place: Origin in the link's frame, in [m].
        axes: Its axes as columns, row by row.
    """

    link: int
    place: Triple
    axes: tuple[Triple, Triple, Triple]


@dataclass(frozen=True, slots=True, eq=False)
class RobotTree:
    """Links, frames and motors of one robot.

    Attributes:
        links: The torso, then a link for each joint, parents first.
        bodies: Frames of the model's bodies, by name.
        sites: Frames of its sites, by name.
        motors: Joints that have an actuator, in the order of those.
        servos: How stiff each is.
        followers: Joints that share a motor, as follower to leader.
    """

    __repr__ = brief_repr

    links: tuple[Link, ...]
    bodies: dict[str, LinkFrame]
    sites: dict[str, LinkFrame]
    motors: tuple[str, ...]
    servos: tuple[Servo, ...]
    followers: dict[str, str]

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of all joints, in the order of the links."""
        return tuple(link.joint for link in self.links[1:])

    @property
    def mass(self) -> float:
        """Mass of the robot, in [kg]."""
        return sum(link.mass for link in self.links)

    def link_of(self, joint: str) -> int:
        """Number of the link that a joint moves."""
        return self.joints.index(joint) + 1

    def chain(self, link: int) -> list[int]:
        """Links from the one below the torso to ``link``."""
        chain: list[int] = []
        while link > 0:
            chain.insert(0, link)
            link = self.links[link].parent
        return chain

    def to_json(self) -> dict[str, Any]:
        """Entries that :meth:`from_json` reads."""
        return {
            "links": [link._asdict() for link in self.links],
            "bodies": {n: f._asdict() for n, f in self.bodies.items()},
            "sites": {n: f._asdict() for n, f in self.sites.items()},
            "motors": list(self.motors),
            "servos": [list(servo) for servo in self.servos],
            "followers": self.followers,
        }

    @classmethod
    def from_json(cls, entries: dict[str, Any]) -> "RobotTree":
        """Read what :meth:`to_json` wrote.

        Raises:
            ModelError: If an entry is missing or ill-typed.
        """
        try:
            known = {f.name: entries[f.name] for f in fields(cls)}
            known["links"] = tuple(
                Link(**{**x, "axis": _triple(x["axis"])})._replace(
                    origin=_triple(x["origin"]), com=_triple(x["com"])
                )
                for x in known["links"]
            )
            for kind in ("bodies", "sites"):
                known[kind] = {n: _frame(x) for n, x in known[kind].items()}
            known["motors"] = tuple(known["motors"])
            known["servos"] = tuple(
                Servo(float(s), float(d)) for s, d in known["servos"]
            )
            return cls(**known)
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise ModelError(f"no tree of a robot: {error!r}") from error


def _triple(numbers: Any) -> Triple:
    x, y, z = (float(number) for number in numbers)
    return x, y, z


def _frame(entries: Any) -> LinkFrame:
    x, y, z = (_triple(row) for row in entries["axes"])
    return LinkFrame(
        int(entries["link"]), _triple(entries["place"]), (x, y, z)
    )


def write_tree(tree: RobotTree, digest: str, version: int) -> str:
    """Text of a tree's file: one link or frame a line."""
    entries = tree.to_json()
    lines = [f'{{"version": {version},', f' "digest": "{digest}",']
    links = ",\n  ".join(json.dumps(link) for link in entries["links"])
    lines.append(f' "links": [\n  {links}],')
    for kind in ("bodies", "sites"):
        rows = ",\n  ".join(
            f"{json.dumps(name)}: {json.dumps(frame)}"
            for name, frame in entries[kind].items()
        )
        lines.append(f' "{kind}": {{\n  {rows}}},')
    lines.append(f' "motors": {json.dumps(entries["motors"])},')
    lines.append(f' "servos": {json.dumps(entries["servos"])},')
    lines.append(f' "followers": {json.dumps(entries["followers"])}}}')
    return "\n".join(lines) + "\n"
