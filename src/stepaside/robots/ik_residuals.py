"""Errors of a request, and what the unknowns do to them.

All in a level frame at the torso that heads as it does. The torso stays
level, or leans by what is given, so that its unknowns are its velocity and
its turning about the vertical; a row for each foot's place and rotation, and
for the CoM.
"""

from collections.abc import Callable
from typing import NamedTuple

from .expression_tracing import ExpressionTrace, Number, cosine, sine
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
HEADING = (0.0, 0.0, 0.0, 1.0)  # of the torso, by its unknowns
SIDES = ("left", "right")


class PostureTargets(NamedTuple):
    """What is asked for, in the torso frame; positions from its origin.

    Attributes:
        com: CoM, in [m].
        feet: Left and right foot, in [m].
        yaws: Cosine and sine of the heading of each foot.
        leans: Rotation of each foot beyond level, in [rad].
    """

    com: Vector
    feet: tuple[Vector, Vector]
    yaws: tuple[Vector, Vector]
    leans: tuple[Vector, Vector]


class TorsoPose(NamedTuple):
    """Where a level torso is.

    Attributes:
        place: Its origin, in [m].
        heading: Its heading, in [rad].
    """

    place: Vector
    heading: Number

    def seen(self, vector: Vector) -> list[Number]:
        """A vector of the world in the torso frame."""
        x, y, z = vector
        c, s = cosine(self.heading), sine(self.heading)
        return [c * x + s * y, c * y - s * x, z]

    def moved(self, move: Vector) -> list[Number]:
        """Place and heading after a move in the torso frame."""
        x, y, z, turn = move
        c, s = cosine(self.heading), sine(self.heading)
        place = add(self.place, [c * x - s * y, s * x + c * y, z])
        return [*place, self.heading + turn]


def trace_asked(trace: ExpressionTrace, torso: TorsoPose) -> PostureTargets:
    """Arguments of a traced function, as :class:`.BodyReference` has them."""

    def numbers(name: str, axes: str) -> list[Number]:
        return [trace.variable(f"{name}_{axis}") for axis in axes]

    com = numbers("com", "xyz")
    feet = [numbers(f"{side}_foot", "xyzt") for side in SIDES]
    tilts = [numbers(f"{side}_tilt", "xy") for side in SIDES]
    places, yaws, leans = [], [], []
    for (x, y, z, heading), (roll, pitch) in zip(feet, tilts, strict=True):
        places.append(torso.seen(subtract([x, y, z], torso.place)))
        yaw = heading - torso.heading
        c, s = cosine(yaw), sine(yaw)
        yaws.append((c, s))
        leans.append((c * roll - s * pitch, s * roll + c * pitch, 0.0))
    return PostureTargets(
        torso.seen(subtract(com, torso.place)),
        (places[0], places[1]),
        (yaws[0], yaws[1]),
        (leans[0], leans[1]),
    )


class FootError(NamedTuple):
    """What a foot is off by.

    Attributes:
        place: Where the foot is, in [m].
        move: How far it has to move, in [m].
        turn: How far it has to turn, in [rad].
    """

    place: Vector
    move: Vector
    turn: Vector


class TracedLegs(NamedTuple):
    """Legs with traced angles, and what is asked of them.

    Attributes:
        legs: The legs.
        trace: The trace. Its arguments are the angles of the free joints,
            place and heading of the torso, and what is asked, as the fields
            of :class:`.BodyReference` name it; the roll of a torso that
            leans.
        free: The free joints.
        torso: Where the torso is.
        placed: All links.
        moments: Their masses.
        asked: What is asked for.
    """

    legs: LegJoints
    trace: ExpressionTrace
    free: list[Number]
    torso: TorsoPose
    placed: LinkPoses
    moments: MassMoments
    asked: PostureTargets

    @classmethod
    def of(cls, legs: LegJoints, hints: dict[str, float]) -> "TracedLegs":
        """Trace where the links are, near a posture."""
        trace = ExpressionTrace()
        free: list[Number] = [
            trace.variable(f"q{i}", hints.get(name, 0.0))
            for i, name in enumerate(legs.free)
        ]
        place = [trace.variable(f"torso_{axis}") for axis in "xyz"]
        torso = TorsoPose(place, trace.variable("torso_t"))
        asked = trace_asked(trace, torso)
        axes = legs.torso_axes(trace)
        placed = place_links(legs.tree, legs.angles(free), axes)
        moments = gather_moments(placed)
        return cls(legs, trace, free, torso, placed, moments, asked)

    @property
    def first_moment(self) -> list[Number]:
        """Mass times CoM of all links from the torso, in [kg m]."""
        return turn(self.placed.axes[0], self.moments.firsts[0])

    @property
    def com_error(self) -> list[Number]:
        """How far the CoM has to move, in [m]."""
        share = 1.0 / self.moments.masses[0]
        com = scale(share, self.first_moment)
        return subtract(self.asked.com, com)

    def foot_error(self, side: int) -> FootError:
        """What the left (0) or right (1) foot is off by."""
        frame = self.legs.tree.sites[self.legs.sites[side]]
        place = self.placed.place_of(frame)
        move = subtract(self.asked.feet[side], place)
        turn = _turn(self.placed.axes_of(frame), self.asked.yaws[side])
        return FootError(place, move, add(turn, self.asked.leans[side]))

    @property
    def heading_error(self) -> Number:
        """How far the torso has to turn to head where the feet do, [rad].

        The tangent of it: the same after a full turn.
        """
        (c, s), (d, t) = self.asked.yaws
        return (s + t) / (c + d)


def _turn(axes: Matrix, yaw: Vector) -> list[Number]:
    """Small rotation, in [rad], that levels a frame and turns it to a yaw.

    Half the sum of the cross products of the axes with where they should be.
    """
    c, s = yaw
    wanted = ((c, s, 0.0), (-s, c, 0.0), UP)
    total: list[Number] = [0.0, 0.0, 0.0]
    for axis, target in zip(transpose(axes), wanted, strict=True):
        total = add(total, cross(axis, target))
    return scale(0.5, total)


def trace_rows(
    legs: LegJoints, hints: dict[str, float]
) -> Callable[..., tuple[float, ...]]:
    """Write out errors and Jacobian.

    Args:
        legs: The legs.
        hints: A usual posture, by joint, in [rad].

    Returns:
        A function of the arguments of :class:`TracedLegs`. It gives the
        errors of all rows: of the left foot's place and rotation, the right
        one's, the CoM, and of the torso's heading where the legs hold it.
        Then it gives the Jacobian, row by row: by the torso's velocity and
        turning, and by the free joints.
    """
    traced = TracedLegs.of(legs, hints)
    moments, placed = traced.moments, traced.placed
    mass = moments.masses[0]
    errors: list[Number] = []
    rows: list[list[Number]] = [
        [0.0] * FIXED_ROWS for _ in range(BASE + len(legs.free))
    ]
    for side in (0, 1):
        at = 6 * side
        error = traced.foot_error(side)
        errors += [*error.move, *error.turn]
        for k in range(3):
            rows[k][at + k] = 1.0
        rows[3][at : at + 6] = [*cross(UP, error.place), *UP]
        for link in legs.chain(side):
            column = rows[BASE + _column(legs, link)]
            found = motion_of(placed, moments, link, error.place)
            column[at : at + 6] = add(
                column[at : at + 6], [*found.linear, *found.angular]
            )
    errors += traced.com_error
    for k in range(3):
        rows[k][12 + k] = 1.0
    rows[3][12:] = scale(1.0 / mass, cross(UP, traced.first_moment))
    for link, moved in enumerate(legs.columns):
        if moved is not None:
            column = rows[BASE + moved]
            found = motion_of(placed, moments, link, (0.0, 0.0, 0.0))
            column[12:] = add(column[12:], scale(1.0 / mass, found.moment))
    if legs.holds_heading:
        errors.append(traced.heading_error)
        for column, entry in zip(rows, HEADING, strict=False):
            column.append(entry)
        for column in rows[BASE:]:
            column.append(0.0)
    entries = [x for row in transpose(rows) for x in row]
    return traced.trace.function("leg_rows", [*errors, *entries])


def _column(legs: LegJoints, link: int) -> int:
    column = legs.columns[link]
    assert column is not None
    return column
