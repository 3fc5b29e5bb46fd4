"""Duels with forces, feet, references and plans recorded at every tick."""

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
from ..games.walker import SimulatedPlayer
from ..planning import ManeuverPlan
from ..robots.description import load_robot


class WalkedPlan(NamedTuple):
    """Plan that was walked until it was replaced.

    Attributes:
        start_time: Begin of its motion, not necessarily at a tick, in [s].
        first_sent_time: Tick of the first joint targets of the plan, in [s].
        from_standing: Whether the robot stood at its begin.
    """

    start_time: float
    first_sent_time: float
    from_standing: bool


@dataclass(frozen=True, slots=True)
class InstrumentedDuel:
    """Duel with records of every control tick.

    Attributes:
        settings: Settings, with the initial poses that were drawn.
        outcome: Outcome of the duel.
        duration: Simulated time, in [s].
        times: Times of the samples of the trajectories, in [s]. Shape (m,).
        tracks: Trajectory of each robot, by name.
        ticks: Times of the control ticks, in [s]. Shape (n,).
        loads: By robot, loads of left and right foot at the end of each
            tick, in [N]. Shape (n, 2).
        feet: By robot, positions of left and right foot in the world at the
            end of each tick, in [m]. Shape (n, 2, 2).
        references: By robot, CoM reference of the joint targets of each
            tick, in the odometry frame, in [m]. Shape (n, 2).
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


def play_instrumented(settings: DuelSettings) -> InstrumentedDuel:
    """Play a duel to its end, as ``run_duel`` does, recording every tick.

    Raises:
        StepAsideError: If the settings are invalid.
    """
    duel = Duel(settings)
    world = duel.world
    period = world.physics.tick
    count = ceil(settings.duration / period - 1e-9)
    recorders = [
        _TickRecorder(duel, player, count)
        for player in duel.players
        if isinstance(player, SimulatedPlayer)
    ]
    outcome: Outcome | None = None
    while outcome is None and world.ticks < count:
        tick, now = world.ticks, world.time
        outcome = duel.tick()
        for recorder in recorders:
            recorder.record(tick, now)
    duel.close()
    outcome = outcome or Outcome.COMPLETED
    duel.recorder.ended(duel, outcome)
    done = world.ticks
    return InstrumentedDuel(
        settings=duel.settings,
        outcome=outcome,
        duration=world.time,
        times=duel.recorder.times,
        tracks=duel.recorder.tracks(),
        ticks=np.arange(done, dtype=np.float64) * period,
        loads={r.name: r.loads[:done] for r in recorders},
        feet={r.name: r.feet[:done] for r in recorders},
        references={r.name: r.references[:done] for r in recorders},
        plans={r.name: tuple(r.plans) for r in recorders},
    )


class _TickRecorder:
    """Recorder of one robot of a duel at every tick."""

    def __init__(
        self, duel: Duel, walker: SimulatedPlayer, count: int
    ) -> None:
        """Find the sensors and allocate arrays for a number of ticks."""
        self.name = walker.name
        self._scheme: ControlScheme = walker.scheme
        self._plan: ManeuverPlan | None = None
        self._world, model = duel.world, duel.world.model
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

    def record(self, tick: int, now: float) -> None:
        """Record the state after a tick that began at ``now``, in [s]."""
        scheme, data = self._scheme, self._world.data
        self._world.update_sensors()
        self.loads[tick] = data.sensordata[self._sensors].sum(axis=1)
        self.feet[tick] = data.site_xpos[self._sites, :2]
        self.references[tick] = scheme.state.reference.com[:2]
        plan = scheme.state.plan
        if plan is not self._plan and plan is not None:
            standing = plan.schedule.standing
            start_time = scheme.state.plan_started
            self.plans.append(WalkedPlan(start_time, now, standing))
        self._plan = plan
