"""Guard that admits only maneuvers after which the robot can stop clear.

A standing robot cannot hit a static obstacle. So a maneuver is executed only
if its first step *and* the halt after it keep clear of all known obstacles.
Otherwise the robot halts; that halt was checked when the previous step was
accepted. By induction, a robot that starts clear never touches a static
obstacle, whatever its strategy requests.

A map built from observations may be off by one cell. A robot that stands
within the margin of such a map would be stuck, since every step sways: if
no maneuver with either foot is accepted, it executes the one that leads out
of the margin with the least approach, at most one cell.
"""

from collections.abc import Callable, Iterator
from math import cos, pi, radians, sin
from operator import itemgetter
from typing import NamedTuple

import numpy as np

from ..arena import ObstacleSet, Room
from ..core.poses import Array, Pose, arc, rotate
from ..perception.floor_map import CELL, FloorMap
from ..perception.measurement import RobotState
from ..planning import GaitSettings, ManeuverPlan, ManeuverPlanner
from ..planning.maneuver import landing_state
from ..strategies.knowledge import Intent
from ..strategies.velocity_set import STILL, BodyVelocity, VelocitySet
from .control_settings import ControlSettings, StabiliserSettings
from .locomotion import GuardDecision, Surroundings
from .swept_outline import BodyOutline, lateral_sway
from .zmp.mpc import load_solver

AHEAD = 2.0  # horizon for moving obstacles: two steps, in [s]
REFRESH_PERIOD = 0.25  # of obstacles that may change, in [s]


class KnownRoom(Surroundings):
    """A given room, with a sensor for the pose in it.

    Odometry that only counts steps drifts: the measured pose aligns it. Pushed
    boxes cover the floor until a halt begun with the next step has ended.
    """

    needs_pose = True

    def __init__(self, room: Room, start: Pose) -> None:
        self._room, self._next = room, 0.0
        self.solids = ObstacleSet(room.solids_at(0.0, AHEAD))
        self.pose_odometry_in_map = start

    def note(self, measurement: RobotState, pose: Pose) -> None:
        """Align odometry with the measured pose; update moving obstacles."""
        if measurement.pose_in_room is not None:
            self.pose_odometry_in_map = measurement.pose_in_room.compose(
                pose.inverse()
            )
        now = measurement.time
        if self._room.moving and now >= self._next - 1e-9:
            self._next = now + REFRESH_PERIOD
            self.solids = ObstacleSet(self._room.solids_at(now, AHEAD))


class MappedRoom(Surroundings):
    """Map from the own depth camera, in odometry.

    Unknown cells are obstacles, too, if unknown floor counts as occupied.
    """

    map_error = CELL

    def __init__(self, floor: FloorMap, *, unknown_is_free: bool) -> None:
        """Begin without obstacles; perception updates the map."""
        self._floor, self._unseen_is_free = floor, unknown_is_free
        self._read, self._next = 0, 0.0

    def note(self, measurement: RobotState, pose: Pose) -> None:
        """Read the map again if it has changed, a few times in each step."""
        now, version = measurement.time, self._floor.version
        if now < self._next - 1e-9 or version == self._read:
            return
        self._read, self._next = version, now + REFRESH_PERIOD
        known = self._floor.occupied()
        if not self._unseen_is_free:
            known += self._floor.unknown(pose[:2])
        self.solids = ObstacleSet(known)


SPEED_SCALES = (1.0, 0.5, 0.05)  # tried in turn; the last only turns
SHARP = 2.0  # heading of a step back if no other is clear, in [rad]
NEARER = 1e-6  # approach tolerated inside the margin, in [m]
GAINED = 0.004  # clearance that an escape gains at least, in [m]


DEVIATIONS = tuple(radians(angle) for angle in range(-120, 121, 15))
SHARES = (1.0, 0.6, 0.3, 0.0)  # of the desired speed
SLOWING = 1.5  # cost of giving up all speed, as a deviation in [rad]
SAMPLES = 9  # of an arc until the next decision; chords are off by < 1 mm
GAIN = 0.005  # by which a robot too near must gain clearance, in [m]


PlanFor = Callable[[GuardDecision], ManeuverPlan]


ESCAPES = tuple(
    GuardDecision(Intent(heading), back)
    for heading in (pi, -pi)
    for back in (False, True)
)


class ManeuverClearance(NamedTuple):
    """Clearance of the body over the first step of a maneuver and its halt."""

    now: float  # clearance at the start [m]
    least: float  # least clearance during the first step and the halt [m]
    last: float  # clearance after the halt [m]

    def escapes(
        self, margin: float, map_error: float, gained: float = NEARER
    ) -> bool:
        """Return whether the maneuver leads out of the margin.

        It loses no more clearance on the way than the map may be wrong.
        """
        farther = self.last > min(self.now + gained, margin)
        near = self.least >= self.now - map_error - NEARER
        return self.now < margin and farther and near


class Guard:
    """Filter of intents that keeps a robot clear of known obstacles."""

    def __init__(
        self,
        surroundings: Surroundings,
        outline: BodyOutline,
        planner: ManeuverPlanner,
        *,
        margin: float,
        footholds: "FootstepAdjustment | None" = None,
    ) -> None:
        """Prepare the guard; with the MPC footsteps are adjusted."""
        self._footholds = footholds
        self.surroundings, self.margin = surroundings, margin
        self._outline, self._planner = outline, planner

    @property
    def map_error(self) -> float:
        """Largest position error of the obstacles, in [m]."""
        return self.surroundings.map_error

    def note(self, measurement: RobotState, pose: Pose) -> None:
        """Update the obstacles; see :meth:`.Surroundings.note`."""
        self.surroundings.note(measurement, pose)

    def choose(
        self,
        intent: Intent,
        plan_for: PlanFor,
        pose_plan_in_odometry: Pose,
        *,
        standing: bool,
    ) -> GuardDecision | None:
        """Return the accepted decision that is closest to an intent.

        First at lower speed, then turning to the other side, and from standing
        backward.
        """
        for choice in _choices(intent, standing=standing):
            if self.accepts(
                plan_for(choice), pose_plan_in_odometry, standing=standing
            ):
                return choice
        return None

    def choose_escape(
        self, intent: Intent, plan_for: PlanFor, pose_plan_in_odometry: Pose
    ) -> GuardDecision | None:
        """Return the decision that leads a standing robot out of the margin.

        Its least clearance is the largest.
        """
        out = []
        for choice in (*_choices(intent, standing=True), *ESCAPES):
            clearance = self.evaluate(plan_for(choice), pose_plan_in_odometry)
            if clearance.escapes(self.margin, self.map_error, GAINED):
                out.append((clearance.least, choice))
        return max(out, key=itemgetter(0))[1] if out else None

    def adjust_footsteps(
        self, plan: ManeuverPlan, pose_plan_in_odometry: Pose
    ) -> ManeuverPlan:
        """Return a plan with adjusted footsteps, if adjustment is enabled."""
        if self._footholds is None:
            return plan
        pose_plan_in_map = self.surroundings.pose_odometry_in_map.compose(
            pose_plan_in_odometry
        )
        return self._footholds.adjust(
            plan, pose_plan_in_map, self.surroundings.solids
        )

    def accepts(
        self,
        plan: ManeuverPlan,
        pose_plan_in_odometry: Pose,
        *,
        standing: bool,
    ) -> bool:
        """Return whether a maneuver may be executed.

        Inside the margin a standing robot may move out of it.
        """
        if not self.surroundings.solids:
            return True
        clearance = self.evaluate(plan, pose_plan_in_odometry)
        if clearance.least >= self.margin:
            return True
        return standing and clearance.escapes(self.margin, 0.0)

    def evaluate(
        self, plan: ManeuverPlan, pose_plan_in_odometry: Pose
    ) -> ManeuverClearance:
        """Return the clearance of the first step of a plan and its halt."""
        pose_plan_in_map = self.surroundings.pose_odometry_in_map.compose(
            pose_plan_in_odometry
        )
        landed = Pose(*plan.placements[2].tolist())
        halt = self.halt_after(plan)
        solids = self.surroundings.solids
        step = self._outline.along(plan, pose_plan_in_map, "step")
        rest = self._outline.along(
            halt, pose_plan_in_map.compose(landed), "all"
        )
        corners = np.concatenate([step, rest])
        clear = solids.swept_clearances(corners)
        now, last = (
            float(solids.swept_clearances(end)[0])
            for end in (corners[:1], corners[-1:])
        )
        return ManeuverClearance(now, float(clear.min()), last)

    def halt_after(self, plan: ManeuverPlan) -> ManeuverPlan:
        """Plan the halt after the first step of a plan.

        Its frame is that of the foot that lands.
        """
        back = Pose(*plan.placements[2].tolist()).inverse()
        return self._planner.plan_halt(
            first_foot=plan.first_foot.other,
            state=landing_state(plan),
            swing_start=back.compose(Pose(*plan.placements[1].tolist())),
        )


def _choices(intent: Intent, *, standing: bool) -> Iterator[GuardDecision]:
    """Yield decisions by their difference from an intent, the least first."""
    for share in SPEED_SCALES:
        yield GuardDecision(
            Intent(intent.heading, share * intent.speed_factor)
        )
    yield GuardDecision(
        Intent(-intent.heading, SPEED_SCALES[-1] * intent.speed_factor)
    )
    if standing:
        for heading in (intent.heading, -intent.heading, SHARP, -SHARP):
            yield GuardDecision(Intent(heading), back=True)


class VelocityGuard:
    """Guard that changes a desired velocity as little as necessary.

    A velocity is admissible if the robot, walking at it until the next
    decision and halting then, keeps its clearance. Legs without a lateral
    velocity only slow down. A robot that is too near may move away, and comes
    no nearer on the way.
    """

    def __init__(
        self,
        surroundings: Surroundings,
        velocities: VelocitySet,
        clearance: float,
    ) -> None:
        """Guard one robot; the tube of its legs is added to the clearance."""
        self._surroundings, self._velocities = surroundings, velocities
        self._clearance = clearance + velocities.tube
        sideways = velocities.lateral[1] > velocities.lateral[0]
        changes = [
            (abs(angle) + SLOWING * (1.0 - share), angle, share)
            for angle in (DEVIATIONS if sideways else (0.0,))
            for share in SHARES
        ]
        self._changes = [change[1:] for change in sorted(changes)]

    def note(self, measurement: RobotState, pose: Pose) -> None:
        """Update the known obstacles."""
        self._surroundings.note(measurement, pose)

    def admit(
        self, velocity: BodyVelocity, pose: Pose, duration: float
    ) -> BodyVelocity:
        """Return the admissible velocity nearest to a desired one, or zero."""
        solids = self._surroundings.solids
        if velocity == STILL or not len(solids):
            return velocity
        here = self._surroundings.pose_odometry_in_map.compose(pose)
        tried = [
            self._velocities.nearest(_changed(velocity, angle, share))
            for angle, share in self._changes
        ]
        paths = self._paths(np.array(tried), here, duration)
        at = solids.clearance(paths.reshape(-1, 2)).reshape(len(tried), -1)
        now = float(at[0, 0])
        least = min(self._clearance, now - NEARER)
        admissible = at.min(axis=1) >= least
        if now < self._clearance:
            admissible &= at[:, -1] >= now + GAIN
        # Obstacles may be thinner than the way between two points.
        chords = paths[admissible]
        admissible[admissible] = (
            solids.segments_keep_clear(
                least,
                chords[:, :-1].reshape(-1, 2),
                chords[:, 1:].reshape(-1, 2),
            )
            .reshape(len(chords), paths.shape[1] - 1)
            .all(axis=1)
        )
        if not admissible.any():
            return STILL
        best = int(np.argmax(admissible))
        # The desired velocity itself is left as it is.
        return velocity if self._changes[best] == (0.0, 1.0) else tried[best]

    def _paths(self, tried: Array, here: Pose, duration: float) -> Array:
        """Return the positions in the map at velocities, until it stands.

        In [m], of velocities (n, 3). Shape (n, SAMPLES + 1, 2).
        """
        times = np.linspace(0.0, duration, SAMPLES)
        ahead, left, turn = tried.T[:, :, None]
        arcs = arc(ahead * times, left * times, turn * times)
        x, y = rotate(arcs[..., 0], arcs[..., 1], here.theta)
        halts = [
            part * halting / max(-low, high, 1e-9)
            for part, (low, high), halting in zip(
                (ahead, left),
                self._velocities[:2],
                self._velocities.halting,
                strict=False,
            )
        ]
        end = here.theta + turn * duration
        u, v = rotate(halts[0], halts[1], end)
        x = np.concatenate([x, x[:, -1:] + u], axis=1)
        y = np.concatenate([y, y[:, -1:] + v], axis=1)
        return np.stack([here.x + x, here.y + y], axis=-1)


def _changed(
    velocity: BodyVelocity, angle: float, share: float
) -> BodyVelocity:
    """Return a velocity in another direction and with a share of its speed."""
    c, s = share * cos(angle), share * sin(angle)
    ahead, left, turn = velocity
    return BodyVelocity(c * ahead - s * left, s * ahead + c * left, turn)


SOLVED = 1  # smallest exit flag of the solver for a solution
NEGLIGIBLE = 1e-9  # violation that is tolerated, in [m]


class FootstepAdjustment:
    r"""Moves the footsteps of plans away from obstacles.

    Following the sequel of the paper (De Simone et al., IROS 2017),
    orientations are chosen first, and then footsteps :math:`p_i` as close to
    the planned ones :math:`p_i^*` as half planes allow,

    .. math:: \min_p \sum_i
       \lVert (p_i - p_{i-1}) - (p_i^* - p_{i-1}^*) \rVert^2, \qquad
       n_{ij} \cdot m_i \ge n_{ij} \cdot q_{ij} + r, \qquad
       R_{i-1}^T (p_i - p_{i-1}) \in K,

    one for each footstep i and each obstacle j within range. :math:`m_i` is
    midway between the feet, :math:`q_{ij}` the obstacle point closest to the
    planned :math:`m_i`, and :math:`n_{ij}` points from it to there. r is the
    clearance that the body requires, or its present clearance if that is
    smaller, and K is the reachable region of a leg.
    """

    def __init__(
        self,
        planner: ManeuverPlanner,
        reach: StabiliserSettings,
        radius: float,
    ) -> None:
        self._planner, self._reach = planner, reach
        self._solver = load_solver()
        self.radius = radius  # [m]

    def adjust(
        self, plan: ManeuverPlan, pose_plan_in_map: Pose, solids: ObstacleSet
    ) -> ManeuverPlan:
        """Return the plan with footsteps that keep clear.

        It is the plan itself if it keeps clear already, and also if no
        reachable footsteps do: the guard checks the result.
        """
        steps = plan.placements[2:]
        rows, least = self._half_planes(plan, pose_plan_in_map, solids)
        if (
            not len(least)
            or (rows @ steps[:, :2].ravel() >= least - NEGLIGIBLE).all()
        ):
            return plan
        reached, low, high = self._within_reach(plan)
        count = len(steps)
        along = np.kron(np.eye(count) - np.eye(count, k=-1), np.eye(2))
        cost = along.T @ along
        found, _, flag, _ = self._solver.solve(
            cost,
            -cost @ steps[:, :2].ravel(),
            np.concatenate([rows, reached]),
            np.concatenate([np.full(len(rows), np.inf), high]),
            np.concatenate([least, low]),
            np.zeros(len(rows) + len(reached), dtype=np.int32),
        )
        if flag < SOLVED:
            return plan
        placements = plan.placements.copy()
        placements[2:, :2] = found.reshape(count, 2)
        return self._planner.placed(plan, placements)

    def _half_planes(
        self, plan: ManeuverPlan, pose_plan_in_map: Pose, solids: ObstacleSet
    ) -> tuple[Array, Array]:
        """Return the half planes as rows and lower bounds on all footsteps.

        Shapes (m, 2 count), (m,).
        """
        steps, sides = plan.placements[2:, :2], _sides(plan)
        theta = plan.placements[2:, 2]
        right = np.stack([np.sin(theta), -np.cos(theta)], axis=-1)
        half = 0.5 * plan.gait.foot_spacing * sides
        here = 0.5 * (plan.placements[0, :2] + plan.placements[1, :2])
        middles = steps + half[:, None] * right
        places = pose_plan_in_map.transform_points(np.vstack([here, middles]))
        span = float(np.hypot(*(middles - here).T).max())
        clear = solids.clearances(places)
        near = clear[0] <= self.radius + 2.0 * span
        back = Pose(0.0, 0.0, -pose_plan_in_map.theta)
        out = solids.directions_out(places[1:])[:, near]
        normals = back.transform_points(out)
        least = np.minimum(self.radius, clear[0, near]) - clear[1:, near]
        least += (normals * steps[:, None]).sum(axis=2)
        each = np.arange(len(steps))
        rows = np.zeros((*least.shape, len(steps), 2))
        rows[each, :, each] = normals
        return rows.reshape(least.size, 2 * len(steps)), least.ravel()

    def _within_reach(self, plan: ManeuverPlan) -> tuple[Array, Array, Array]:
        """Return limits on the way from one foot to the next, as rows.

        Shapes (2 count, 2 count), (2 count,), (2 count,).
        """
        gait, own = plan.gait, self._reach
        before, steps = plan.placements[1:-1], plan.placements[2:]
        c, s, side = np.cos(before[:, 2]), np.sin(before[:, 2]), _sides(plan)
        axes = np.array([[c, s], [-s * side, c * side]]).transpose(2, 0, 1)
        each = np.arange(len(steps))
        rows = np.zeros((len(steps), 2, len(steps), 2))
        rows[each, :, each] = axes
        # The first step begins at the support foot, the origin.
        rows[each[1:], :, each[:-1]] = -axes[1:]
        wanted = (axes @ (steps - before)[:, :2, None])[..., 0]
        near = 2.0 * gait.sole.inner + own.gap
        far = gait.foot_spacing + own.reach_outward
        low = np.minimum((-gait.stride, near), wanted)
        high = np.maximum((gait.stride, far), wanted)
        return rows.reshape(low.size, -1), low.ravel(), high.ravel()


def _sides(plan: ManeuverPlan) -> Array:
    sides: Array = np.ones(len(plan.placements) - 2)
    sides[1::2] = -1.0
    return plan.first_foot.value * sides


class ClearanceSetup(NamedTuple):
    """Known obstacles, body outline and required clearance of one robot."""

    surroundings: Surroundings  # known obstacles
    outline: BodyOutline
    margin: float  # required clearance [m]

    def radius(self, gait: GaitSettings) -> float:
        """Return the least distance of a walking CoM from obstacles [m]."""
        return self.outline.radius + self.margin + lateral_sway(gait)

    def guard(self, gait: GaitSettings, control: ControlSettings) -> Guard:
        """Build the guard; with the MPC it also adjusts footsteps."""
        planner = ManeuverPlanner(gait)
        footholds = None
        if control.method == "mpc":
            footholds = FootstepAdjustment(
                planner, control.stabiliser, self.radius(gait)
            )
        return Guard(
            *(self.surroundings, self.outline, planner),
            margin=self.margin,
            footholds=footholds,
        )

    def velocity_guard(self, velocities: VelocitySet) -> VelocityGuard:
        """Build the guard of learned legs."""
        distance = self.outline.radius + self.margin
        return VelocityGuard(self.surroundings, velocities, distance)
