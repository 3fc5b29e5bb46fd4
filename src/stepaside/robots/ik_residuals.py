"""Residuals and Jacobian of floating-base inverse kinematics.

All quantities are in the level torso frame: origin and heading of the torso,
vertical z axis. The torso is level or has a given roll, so that its unknowns
are three translations and the rotation about the vertical. Rows are position
and orientation of each foot, and the CoM.
"""

from typing import NamedTuple

from .expression_tracing import ExpressionTrace, Formula, Number, cosine, sine
from .leg_joints import BASE, FIXED_ROWS, LegJoints
from .link_poses import (
    LinkPoses,
    MassMoments,
    gather_moments,
    motion_of,
    place_links,
)
from .scalar_algebra import (
    Matrix,
    Vector,
    add,
    cross,
    scale,
    subtract,
    transpose,
    turn,
)

UP = (0.0, 0.0, 1.0)
HEADING = (0.0, 0.0, 0.0, 1.0)  # Jacobian row of the torso heading
SIDES = ("left", "right")


class PostureTargets(NamedTuple):
    """Targets in the level torso frame.

    Attributes:
        com: Position of the CoM, in [m].
        feet: Positions of left and right foot, in [m].
        yaws: Cosine and sine of the heading of each foot.
        tilts: Small rotation of each foot from level, in [rad].
    """

    com: Vector
    feet: tuple[Vector, Vector]
    yaws: tuple[Vector, Vector]
    tilts: tuple[Vector, Vector]


class TorsoPose(NamedTuple):
    """Pose of the level torso frame in the frame of the reference.

    Attributes:
        position: Origin of the torso, in [m].
        heading: Heading of the torso, in [rad].
    """

    position: Vector
    heading: Number

    def to_torso(self, vector: Vector) -> list[Number]:
        """Rotate a vector from the reference frame to the torso frame."""
        x, y, z = vector
        c, s = cosine(self.heading), sine(self.heading)
        return [c * x + s * y, c * y - s * x, z]

    def moved(self, move: Vector) -> list[Number]:
        """Return position and heading after a move in the torso frame."""
        x, y, z, turn = move
        c, s = cosine(self.heading), sine(self.heading)
        position = add(self.position, [c * x - s * y, s * x + c * y, z])
        return [*position, self.heading + turn]


def trace_targets(trace: ExpressionTrace, torso: TorsoPose) -> PostureTargets:
    """Add the fields of :class:`.BodyReference` as variables of a trace."""

    def variables(name: str, axes: str) -> list[Number]:
        return [trace.variable(f"{name}_{axis}") for axis in axes]

    com = variables("com", "xyz")
    feet = [variables(f"{side}_foot", "xyzt") for side in SIDES]
    foot_tilts = [variables(f"{side}_tilt", "xy") for side in SIDES]
    positions, yaws, tilts = [], [], []
    for (x, y, z, heading), (roll, pitch) in zip(
        feet, foot_tilts, strict=True
    ):
        positions.append(torso.to_torso(subtract([x, y, z], torso.position)))
        yaw = heading - torso.heading
        c, s = cosine(yaw), sine(yaw)
        yaws.append((c, s))
        tilts.append((c * roll - s * pitch, s * roll + c * pitch, 0.0))
    return PostureTargets(
        torso.to_torso(subtract(com, torso.position)),
        (positions[0], positions[1]),
        (yaws[0], yaws[1]),
        (tilts[0], tilts[1]),
    )


class FootError(NamedTuple):
    """Position of a foot, and its distance from its target.

    Attributes:
        position: Present position of the foot, in [m].
        translation: Translation to the target, in [m].
        rotation: Small rotation to the target, in [rad].
    """

    position: Vector
    translation: Vector
    rotation: Vector


class TracedLegs(NamedTuple):
    """Legs with traced joint angles, and their targets.

    Attributes:
        legs: Leg joints.
        trace: The trace. Its arguments are the angles of the free joints,
            position and heading of the torso, the fields of
            :class:`.BodyReference`, and the roll of a torso that leans.
        free: Angles of the free joints.
        torso: Torso pose.
        links: Poses of all links.
        moments: Mass moments of all links.
        targets: Targets of CoM and feet.
    """

    legs: LegJoints
    trace: ExpressionTrace
    free: list[Number]
    torso: TorsoPose
    links: LinkPoses
    moments: MassMoments
    targets: PostureTargets

    @classmethod
    def of(cls, legs: LegJoints, hints: dict[str, float]) -> "TracedLegs":
        """Trace the link poses near a typical posture."""
        trace = ExpressionTrace()
        free: list[Number] = [
            trace.variable(f"q{i}", hints.get(name, 0.0))
            for i, name in enumerate(legs.free)
        ]
        position = [trace.variable(f"torso_{axis}") for axis in "xyz"]
        torso = TorsoPose(position, trace.variable("torso_t"))
        targets = trace_targets(trace, torso)
        axes = legs.torso_axes(trace)
        links = place_links(legs.tree, legs.angles(free), axes)
        moments = gather_moments(links)
        return cls(legs, trace, free, torso, links, moments, targets)

    @property
    def first_moment(self) -> list[Number]:
        """Mass times CoM of the robot, from the torso, in [kg m]."""
        return turn(self.links.axes[0], self.moments.firsts[0])

    @property
    def com_error(self) -> list[Number]:
        """Translation of the CoM to its target, in [m]."""
        inverse_mass = 1.0 / self.moments.masses[0]
        com = scale(inverse_mass, self.first_moment)
        return subtract(self.targets.com, com)

    def foot_error(self, side: int) -> FootError:
        """Return the error of the left (0) or right (1) foot."""
        frame = self.legs.tree.sites[self.legs.sites[side]]
        position = self.links.position_of(frame)
        translation = subtract(self.targets.feet[side], position)
        levelling = rotation_to_yaw(
            self.links.axes_of(frame), self.targets.yaws[side]
        )
        rotation = add(levelling, self.targets.tilts[side])
        return FootError(position, translation, rotation)

    @property
    def heading_error(self) -> Number:
        """Tangent of the rotation to the mean heading of the feet.

        The tangent does not change with full turns.
        """
        (c, s), (d, t) = self.targets.yaws
        return (s + t) / (c + d)


def rotation_to_yaw(axes: Matrix, yaw: Vector) -> list[Number]:
    """Return the small rotation, in [rad], to a level frame with a yaw.

    Half the sum of the cross products of the axes with their targets.
    """
    c, s = yaw
    targets = ((c, s, 0.0), (-s, c, 0.0), UP)
    total: list[Number] = [0.0, 0.0, 0.0]
    for axis, target in zip(transpose(axes), targets, strict=True):
        total = add(total, cross(axis, target))
    return scale(0.5, total)


def trace_residuals(legs: LegJoints, hints: dict[str, float]) -> Formula:
    """Generate the function of residuals and Jacobian.

    Args:
        legs: Leg joints.
        hints: A typical posture, by joint, in [rad].

    Returns:
        Function of the arguments of :class:`TracedLegs`. Its results are the
        residuals of all rows: position and rotation of the left foot, then
        of the right foot, the CoM, and the torso heading if that has a row;
        then the Jacobian, row by row, with columns of the translation and
        the rotation of the torso, and of the free joints.
    """
    traced = TracedLegs.of(legs, hints)
    moments, links = traced.moments, traced.links
    mass = moments.masses[0]
    errors: list[Number] = []
    rows: list[list[Number]] = [
        [0.0] * FIXED_ROWS for _ in range(BASE + len(legs.free))
    ]
    for side in (0, 1):
        at = 6 * side
        error = traced.foot_error(side)
        errors += [*error.translation, *error.rotation]
        for k in range(3):
            rows[k][at + k] = 1.0
        rows[3][at : at + 6] = [*cross(UP, error.position), *UP]
        for link in legs.chain(side):
            column = rows[BASE + _column(legs, link)]
            motion = motion_of(links, moments, link, error.position)
            column[at : at + 6] = add(
                column[at : at + 6], [*motion.linear, *motion.angular]
            )
    errors += traced.com_error
    for k in range(3):
        rows[k][12 + k] = 1.0
    rows[3][12:] = scale(1.0 / mass, cross(UP, traced.first_moment))
    for link, moved in enumerate(legs.columns):
        if moved is not None:
            column = rows[BASE + moved]
            motion = motion_of(links, moments, link, (0.0, 0.0, 0.0))
            column[12:] = add(column[12:], scale(1.0 / mass, motion.moment))
    if legs.holds_heading:
        errors.append(traced.heading_error)
        for column, entry in zip(rows, HEADING, strict=False):
            column.append(entry)
        for column in rows[BASE:]:
            column.append(0.0)
    entries = [x for row in transpose(rows) for x in row]
    return traced.trace.formula("leg_rows", [*errors, *entries])


def _column(legs: LegJoints, link: int) -> int:
    column = legs.columns[link]
    assert column is not None
    return column
