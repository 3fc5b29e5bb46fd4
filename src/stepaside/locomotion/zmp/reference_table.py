"""References of a plan at the control ticks."""

from math import ceil, cos, sin
from typing import NamedTuple

import numpy as np

from ...core.poses import Pose, wrap_angle
from ...planning import GaitSettings, ManeuverPlan
from ...planning.schedule import Sampler, Schedule
from ...planning.template_path import (
    path_samples,
    poses_on_path,
    progress_by_time,
)
from ...robots.leg_kinematics import BodyReference

CACHED = 256  # samplers; rational durations need only a few


class ReferenceSample(NamedTuple):
    """References of a plan at one tick, in odometry.

    Attributes:
        body: CoM and feet.
        zmp: ZMP reference, in [m].
        dcm: DCM reference, in [m].
        template: Pose of the template unicycle.
        reaction: Shift of the ZMP by the swing leg, in [m]: the pivot of
            the pendulum is the ZMP less this shift.
    """

    body: BodyReference
    zmp: tuple[float, float]
    dcm: tuple[float, float]
    template: Pose
    reaction: tuple[float, float] = (0.0, 0.0)


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
    """References at every tick of the current plan.

    Plans begin when a step ends, which need not be on a tick: the plan is
    sampled at the ticks, so that gait time is exact.
    """

    def __init__(self, tick: float) -> None:
        """Begin empty, for a control period in [s]."""
        self._tick = tick
        self._first = 0
        self._rows: list[ReferenceSample] = []
        self._samplers: dict[tuple[Schedule, int, int], Sampler] = {}

    def load(
        self,
        plan: ManeuverPlan,
        plan_frame: Pose,
        started: float,
        duration: float,
    ) -> None:
        """Sample a plan at the ticks of its first part.

        Args:
            plan: Plan to walk.
            plan_frame: Pose of its frame in odometry.
            started: Start time of the plan, in [s].
            duration: Duration of the part, in [s].
        """
        tick = self._tick
        self._first = ceil((started - 1e-9) / tick)
        offset = self._first * tick - started
        count = max(1, ceil((duration - offset) / tick - 1e-6))
        sampler = self._sampler(plan.schedule, offset, count)
        samples = plan.sample(sampler)
        c, s = cos(plan_frame.theta), sin(plan_frame.theta)
        turn = np.array([[c, s], [-s, c]])
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
        points = points @ turn
        points += plan_frame[:2]
        reaction = [(0.0, 0.0)] * count
        if plan.schedule.has_swing_reaction:
            reaction = ((samples.zmp - samples.pivot) @ turn).tolist()
        com, left, right, zmp, dcm, position = points.reshape(
            6, count, 2
        ).tolist()
        theta = plan_frame.theta
        heading = (template[:, 2] + theta).tolist()
        left_yaw = (samples.left_foot[:, 2] + theta).tolist()
        right_yaw = (samples.right_foot[:, 2] + theta).tolist()
        left_height = samples.left_height.tolist()
        right_height = samples.right_height.tolist()
        self._rows = [
            ReferenceSample(
                BodyReference(
                    (com[i][0], com[i][1], settings.com_height),
                    (left[i][0], left[i][1], left_height[i], left_yaw[i]),
                    (right[i][0], right[i][1], right_height[i], right_yaw[i]),
                ),
                (zmp[i][0], zmp[i][1]),
                (dcm[i][0], dcm[i][1]),
                Pose(position[i][0], position[i][1], heading[i]),
                (reaction[i][0], reaction[i][1]),
            )
            for i in range(count)
        ]

    def at(self, now: float) -> ReferenceSample:
        """Return the references at a tick; after the last one, the last."""
        index = round(now / self._tick) - self._first
        return self._rows[min(index, len(self._rows) - 1)]

    def _sampler(
        self, schedule: Schedule, offset: float, count: int
    ) -> Sampler:
        key = (schedule, round(offset * 1e9), count)
        sampler = self._samplers.get(key)
        if sampler is None:
            times = offset + self._tick * np.arange(count)
            sampler = schedule.sampler(times)
            # Over hours the sums of durations drift, and the keys with them.
            if len(self._samplers) >= CACHED:
                del self._samplers[next(iter(self._samplers))]
            self._samplers[key] = sampler
        return sampler
