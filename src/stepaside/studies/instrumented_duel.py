"""Duels with forces, feet, references and plans recorded at every tick."""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ..core.poses import Array
from ..games.duel_settings import PLAYERS, DuelSettings
from ..games.game import GameInPlay, GameObserver, play
from ..games.physics_world import PhysicsWorld
from ..games.recorded_game import RecordedGame
from ..games.robot_player import RobotPlayer
from ..games.run import Run
from ..robots.description import load_robot


class WalkedPlan(NamedTuple):
    """Plan that was walked until it was replaced."""

    start_time: float  # begin of its motion, not necessarily at a tick [s]
    first_sent_time: float  # tick of the first joint targets of the plan [s]
    from_standing: bool  # whether the robot stood at its begin


@dataclass(frozen=True, slots=True)
class InstrumentedDuel:
    """Duel with records of every control tick."""

    run: Run  # the duel
    ticks: Array  # times of the control ticks [s]. (n,)
    # by robot, loads of left and right foot at the end of each tick [N]. (n,
    # 2)
    loads: dict[str, Array] = field(default_factory=dict)
    # by robot, positions of left and right foot in the world at the end of
    # each tick [m]. (n, 2, 2)
    feet: dict[str, Array] = field(default_factory=dict)
    # by robot, CoM reference of the joint targets of each tick, in the
    # odometry frame [m]. (n, 2)
    references: dict[str, Array] = field(default_factory=dict)
    # by robot, the plans that were walked
    plans: dict[str, tuple[WalkedPlan, ...]] = field(default_factory=dict)


def play_instrumented(settings: DuelSettings) -> InstrumentedDuel:
    """Play a duel to its end, as ``run_duel`` does, recording every tick."""
    observers = {name: _TickObserver(settings, name) for name in PLAYERS}
    duel = RecordedGame(settings, tuple(observers.values()))
    play(duel)
    run, world = duel.run().uninterrupted(), duel.in_physics
    found = InstrumentedDuel(
        run,
        world.physics.tick * np.arange(world.ticks, dtype=np.float64),
    )
    for name, observer in observers.items():
        loads, feet, references = zip(*observer.rows, strict=True)
        found.loads[name] = np.array(loads)
        found.feet[name] = np.array(feet)
        found.references[name] = np.array(references)
        found.plans[name] = tuple(observer.plans)
    return found


class _TickObserver(GameObserver):
    """Observer of one robot of a match: its state at the end of each tick."""

    def __init__(self, settings: DuelSettings, name: str) -> None:
        self.rows: list[tuple[Array, Array, Array]] = []
        self.plans: list[WalkedPlan] = []
        self._name, self._plan = name, object()
        self._robot = load_robot(settings.robot_of(name).robot)

    def before(self, game: GameInPlay) -> None:
        """Record the state after the previous tick."""
        world, robot = game.world, self._robot
        assert isinstance(world, PhysicsWorld)
        if len(self.rows) == world.ticks:
            return
        player = world.player(self._name)
        assert isinstance(player, RobotPlayer)
        walk = player.scheme.walk
        data = world.data
        forces = [
            data.sensor(f"{self._name}/{sensor}").data[0]
            for sensor in robot.sensors.feet  # of the left one first
        ]
        sites = [
            data.site(f"{self._name}/{sole}").xpos[:2]
            for sole in (robot.left_foot, robot.right_foot)
        ]
        self.rows.append(
            (
                np.reshape(forces, (2, -1)).sum(axis=1),
                np.array(sites),
                np.array(walk.reference.com[:2]),
            )
        )
        if walk.plan is not self._plan and walk.plan is not None:
            sent = (world.ticks - 1) * world.physics.tick
            standing = walk.plan.schedule.standing
            self.plans.append(WalkedPlan(walk.plan_started, sent, standing))
        self._plan = walk.plan

    def ended(self, game: GameInPlay) -> None:
        """Record the state after the last tick."""
        self.before(game)
