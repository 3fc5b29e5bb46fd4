"""A duel played under watch: what its record leaves out, tick by tick."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil
from typing import NamedTuple

import numpy as np

from ..control import ControlScheme
from ..core.poses import Array
from ..games.duel import Duel
from ..games.duel_settings import DuelSettings
from ..games.outcome import Outcome
from ..games.trajectory import Trajectory
from ..games.walker import Walker
from ..planning import ManeuverPlan
from ..robots.description import load_robot


class WalkedPlan(NamedTuple):
    """A plan that was walked until another one replaced it.

    Attributes:
        started: When its motion began, which need not be on a tick, in [s].
        sent: Tick at which the joints were first sent some of it, in [s].
        from_rest: Whether the robot stood when it began.
    """

    started: float
    sent: float
    from_rest: bool


@dataclass(frozen=True, slots=True)
class WatchedDuel:
    """A duel and what it left behind.

    Attributes:
        settings: What decided it, with the start that was drawn.
        outcome: How it ended.
        duration: Simulated time, in [s].
        times: Times of the samples of the record, in [s]. Shape (m,).
        tracks: Record of each robot, by name.
        ticks: Times of the control ticks, in [s]. Shape (n,).
        loads: By robot, what the sensors of left and right foot bear at the
            end of each tick, in [N]. Shape (n, 2).
        feet: By robot, where left and right foot are then, in [m].
            Shape (n, 2, 2).
        references: By robot, CoM reference that the joint targets of each
            tick were computed from, in odometry, in [m]. Shape (n, 2).
        plans: By robot, the plans that were walked.
    """

    settings: DuelSettings
    outcome: Outcome
    duration: float
    times: Array
    tracks: Mapping[str, Trajectory]
    ticks: Array
    loads: Mapping[str, Array]
    feet: Mapping[str, Array]
    references: Mapping[str, Array]
    plans: Mapping[str, tuple[WalkedPlan, ...]]


def watch(settings: DuelSettings) -> WatchedDuel:
    """Play a duel to its end, as ``run_duel`` does, and watch it.

    Raises:
        StepAsideError: If the settings ask for what cannot be.
    """
    duel = Duel(settings)
    world = duel.world
    period = world.physics.tick
    count = ceil(settings.duration / period - 1e-9)
    watchers = [
        _Watcher(duel, player, count)
        for player in duel.players
        if isinstance(player, Walker)
    ]
    outcome: Outcome | None = None
    while outcome is None and world.ticks < count:
        tick, now = world.ticks, world.time
        outcome = duel.tick()
        for watcher in watchers:
            watcher.note(tick, now)
    duel.close()
    outcome = outcome or Outcome.COMPLETED
    duel.recorder.ended(duel, outcome)
    done = world.ticks
    return WatchedDuel(
        settings=duel.settings,
        outcome=outcome,
        duration=world.time,
        times=duel.recorder.times,
        tracks=duel.recorder.tracks(),
        ticks=np.arange(done, dtype=np.float64) * period,
        loads={w.name: w.loads[:done] for w in watchers},
        feet={w.name: w.feet[:done] for w in watchers},
        references={w.name: w.references[:done] for w in watchers},
        plans={w.name: tuple(w.plans) for w in watchers},
    )


class _Watcher:
    """Watches one robot of a duel."""

    def __init__(self, duel: Duel, walker: Walker, count: int) -> None:
        """Find its sensors; make room for a number of ticks."""
        self.name = walker.name
        self._scheme: ControlScheme = walker.scheme
        self._plan: ManeuverPlan | None = None
        model, self._data = duel.world.model, duel.world.data
        robot = load_robot(duel.settings.robot_of(self.name).robot)
        feet = robot.sensors.feet
        sensors = [model.sensor(f"{self.name}/{f}") for f in feet]
        addresses = [int(sensor.adr[0]) for sensor in sensors]
        self._sensors = np.array(addresses).reshape(2, -1)  # left, right
        soles = (robot.left_foot, robot.right_foot)
        self._sites = [model.site(f"{self.name}/{s}").id for s in soles]
        self.loads = np.zeros((count, 2))
        self.feet = np.zeros((count, 2, 2))
        self.references = np.zeros((count, 2))
        self.plans: list[WalkedPlan] = []

    def note(self, tick: int, now: float) -> None:
        """Note what a tick, which began at a time, left behind."""
        scheme, data = self._scheme, self._data
        self.loads[tick] = data.sensordata[self._sensors].sum(axis=1)
        self.feet[tick] = data.site_xpos[self._sites, :2]
        self.references[tick] = scheme.reference.com[:2]
        plan = scheme.plan
        if plan is not self._plan and plan is not None:
            standing = plan.schedule.standing
            started = scheme.plan_started
            self.plans.append(WalkedPlan(started, now, standing))
        self._plan = plan
