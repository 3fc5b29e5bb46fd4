"""References of a plan at the control ticks."""

from functools import lru_cache
from math import ceil
from typing import NamedTuple

import numpy as np

from ...core.poses import Array, Pose, wrap_angle
from ...planning import GaitSettings, ManeuverPlan
from ...planning.path import (
    path_samples,
    poses_on_path,
    progress_by_time,
)
from ...planning.schedule import Sampler, Schedule
from ...robots.leg_kinematics import BodyReference

ZERO = (0.0, 0.0)


class ReferenceSample(NamedTuple):
    """References of a plan at one tick, in odometry."""

    body: BodyReference  # CoM and feet
    zmp: tuple[float, float]  # ZMP reference [m]
    dcm: tuple[float, float]  # DCM reference [m]
    template: Pose  # pose of the template unicycle
    reaction: tuple[float, float] = (0.0, 0.0)  # [m]


def standing_reference(
    left_foot: Pose, right_foot: Pose, settings: GaitSettings
) -> BodyReference:
    """Return the reference with the CoM midway between the feet's anchors."""
    x, y = _anchor(left_foot, settings)
    u, v = _anchor(right_foot, settings)
    com = (0.5 * (x + u), 0.5 * (y + v), settings.com_height)
    left = (left_foot.x, left_foot.y, 0.0, left_foot.theta)
    right = (right_foot.x, right_foot.y, 0.0, right_foot.theta)
    return BodyReference(com, left, right)


def initial_stance(settings: GaitSettings) -> BodyReference:
    """Return the reference with the feet abreast, to both sides of (0, 0)."""
    half = 0.5 * settings.foot_spacing
    return standing_reference(
        Pose(0.0, half, 0.0), Pose(0.0, -half, 0.0), settings
    )


def resting_sample(
    left_foot: Pose, right_foot: Pose, settings: GaitSettings
) -> ReferenceSample:
    """Return the references of a standing body, midway between its feet."""
    body = standing_reference(left_foot, right_foot, settings)
    rest = body.com[:2]
    apart = wrap_angle(left_foot.theta - right_foot.theta)
    template = Pose(
        0.5 * (left_foot.x + right_foot.x),
        0.5 * (left_foot.y + right_foot.y),
        right_foot.theta + 0.5 * apart,
    )
    return ReferenceSample(body, rest, rest, template)


def _anchor(foot: Pose, settings: GaitSettings) -> tuple[float, float]:
    ahead = foot.compose(Pose(settings.zmp_forward, 0.0, 0.0))
    return ahead.x, ahead.y


class ReferenceTable:
    """References at every tick of the current plan, or of a standing body.

    Plans are sampled at the ticks, on which they need not begin.
    """

    references: Array  # rows of :meth:`.BodyReference.row`. Shape (ticks, 15)
    zmp: Array  # ZMP references [m]. Shape (ticks, 2)

    def __init__(self, tick: float) -> None:
        """Begin empty, for a control period in [s]."""
        self._tick = tick
        self._first = 0
        self._dcm: Array
        self._reaction: Array | None = None
        self._templates: list[Pose] = []
        self._lists: tuple[list[list[float]], ...] | None = None

    def load(
        self,
        plan: ManeuverPlan,
        plan_frame: Pose,
        started: float,
        duration: float,
    ) -> None:
        """Sample a plan at the ticks of its first part, of a duration in [s].

        Its frame is in odometry.
        """
        tick = self._tick
        self._first = ceil((started - 1e-9) / tick)
        offset = self._first * tick - started
        count = max(1, ceil((duration - offset) / tick - 1e-6))
        sampler = _sampler(plan.schedule, round(offset, 9), tick, count)
        samples = plan.sample(sampler)
        settings = plan.schedule.settings
        path = path_samples(
            plan.placements, plan.first_foot, settings.foot_spacing
        )
        clock = progress_by_time(plan.schedule, sampler.times)
        template = poses_on_path(path, samples.com, clock, settings)
        points = np.concatenate(
            [
                samples.com,
                samples.left_foot[:, :2],
                samples.right_foot[:, :2],
                samples.zmp,
                samples.dcm,
                template[:, :2],
            ]
        )
        points = plan_frame.transform_points(points)
        self._reaction = self._lists = None
        if plan.schedule.has_swing_reaction:
            turned = Pose(0.0, 0.0, plan_frame.theta)
            self._reaction = turned.transform_points(
                samples.zmp - samples.pivot
            )
        com, left, right, zmp, dcm, position = points.reshape(6, count, 2)
        theta = plan_frame.theta
        self.references = np.zeros((count, 15))
        self.references[:, 0:2] = com
        self.references[:, 2] = settings.com_height
        self.references[:, 3:5] = left
        self.references[:, 5] = samples.left_height
        self.references[:, 6] = samples.left_foot[:, 2] + theta
        self.references[:, 7:9] = right
        self.references[:, 9] = samples.right_height
        self.references[:, 10] = samples.right_foot[:, 2] + theta
        self.zmp, self._dcm = zmp, dcm
        heading = template[:, 2] + theta
        rows = np.column_stack([position, heading]).tolist()
        self._templates = [Pose(*row) for row in rows]

    def rest(self, sample: ReferenceSample) -> None:
        """Load the references of a standing body."""
        self._first = 0
        self.references = np.array([sample.body.row()])
        self.zmp, self._dcm = np.array([sample.zmp]), np.array([sample.dcm])
        self._reaction = self._lists = None
        self._templates = [sample.template]

    def index(self, now: float) -> int:
        """Return the index of a tick; it may be beyond the last row."""
        return round(now / self._tick) - self._first

    def template(self, index: int) -> Pose:
        """Return the pose of the template at a tick, in odometry."""
        templates = self._templates
        return templates[index if index < len(templates) else -1]

    def centers(self, index: int) -> tuple[float, float, float, float]:
        """Return CoM and ZMP reference at a tick, (x, y) each, in [m]."""
        i = min(index, len(self.references) - 1)
        row, zmp = self.references, self.zmp
        return row.item(i, 0), row.item(i, 1), zmp.item(i, 0), zmp.item(i, 1)

    def at(self, now: float) -> ReferenceSample:
        """Return the references at a tick; after the last one, the last."""
        return self.sample(self.index(now))

    def sample(self, index: int) -> ReferenceSample:
        """Return the same by the index of the tick."""
        i = min(index, len(self._templates) - 1)
        if self._lists is None:
            arrays = self.references, self.zmp, self._dcm
            self._lists = tuple(array.tolist() for array in arrays)
        references, zmp, dcm = self._lists
        (x, y), (u, v) = zmp[i], dcm[i]
        reaction = ZERO
        if self._reaction is not None:
            p, q = self._reaction[i].tolist()
            reaction = p, q
        body = BodyReference.from_row(references[i])
        template = self._templates[i]
        return ReferenceSample(body, (x, y), (u, v), template, reaction)


@lru_cache(maxsize=256)  # over hours the sums of durations drift
def _sampler(
    schedule: Schedule, offset: float, tick: float, count: int
) -> Sampler:
    return schedule.sampler(offset + tick * np.arange(count))
