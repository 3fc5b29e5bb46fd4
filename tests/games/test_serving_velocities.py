"""Test served duels of robots commanded by velocities."""

import os
from dataclasses import replace
from enum import Enum
from threading import Event, Thread
from typing import Any

import pytest

from commanded_robots import VelocityCommands, commanded_robots
from stepaside.drivers.robot_session import RobotSession
from stepaside.drivers.velocity_limits import REST, VelocityLimits
from stepaside.drivers.velocity_loop import (
    DrivingState,
    TemplateController,
    VelocityLoop,
)
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.game import play
from stepaside.games.robot_endpoints import RobotEndpoint
from stepaside.games.served_duel import serve_duel
from stepaside.games.velocity_walker import VelocityWalker
from stepaside.locomotion.zmp.control_settings import STABILISED
from stepaside.perception.measurement import RobotState
from stepaside.planning import GaitSettings
from stepaside.sim.body_settings import BODIES
from stepaside.strategies import Evasion, Pursuit, Strategy
from stepaside.strategies.velocity_set import BodyVelocity

SETTINGS = DuelSettings(
    seed=7,
    duration=3.0,
    start=StartSettings(0.75, 0.2, 0.1),
    body=replace(BODIES["delayed"], cycle=0.012),
    control=STABILISED,
)
DOMAIN = 20 + os.getpid() % 200
ROLES: dict[str, Strategy] = {"pursuer": Pursuit(), "evader": Evasion()}


def playing_of(session: Any, strategy: Strategy) -> VelocityLoop:
    return VelocityLoop(
        session,
        lambda: TemplateController(strategy, GaitSettings()),
        VelocityLimits(),
        paced=False,
    )


class NoWire:
    """Player and robot in one process, with a report every fourth tick."""

    def __init__(self, robot: VelocityWalker, strategy: Strategy) -> None:
        self._robot, self._ticks, self._velocity = robot, 0, REST
        self.robot = robot  # whose method command is called
        self._playing = playing_of(self, strategy)
        for _ in range(3):  # what a gathering world tells again and again
            self._playing.tick()

    def listen(self, patience: float) -> RobotState:
        """State that the robot reports."""
        state = self._robot.state()
        return RobotState(state.time, sighting=state.sighting, pose=state.pose)

    def released(self) -> str:
        """Have no switch."""
        return ""

    def command(self, call: Any) -> None:
        """Take what is asked for."""
        self._velocity = BodyVelocity(*call.args)

    def halt(self) -> None:
        """Rest."""
        self._velocity = REST

    def act(self) -> BodyVelocity:
        """Command of this tick."""
        if self._ticks % 4 == 0:
            self._playing.tick()
        self._ticks += 1
        return self._velocity

    def close(self) -> None:
        """Nothing to let go of."""


@pytest.fixture(scope="module")
def distance_without_a_wire() -> float:
    """Return the final distance of a duel in one process, in [m]."""
    game, robots = commanded_robots(SETTINGS)
    sources = {robot: NoWire(robot, ROLES[robot.name]).act for robot in robots}
    game.observers = (VelocityCommands(sources),)
    play(game)
    return min(game.closest.values())


def client(
    namespace: str,
    strategy: Strategy,
    states: list[Enum],
    over: Event,
) -> None:
    """Play one player until the duel is over."""
    from stepaside.drivers.robot_loader import RobotRequest
    from stepaside.drivers.ros2 import make_robot

    robot = make_robot(RobotRequest(namespace, domain=DOMAIN))()
    session = RobotSession(robot)
    session.run("prepare", 20.0)
    playing = playing_of(session, strategy)
    while not over.is_set():
        states.append(playing.tick().state)
    playing.close()


def served(
    endpoints: dict[str, RobotEndpoint],
) -> tuple[float, list[Enum]]:
    """Return the smallest distance of a served duel, and its plays."""
    states: list[Enum] = []
    over = Event()
    threads = [
        Thread(target=client, args=(f"/{name}", ROLES[name], states, over))
        for name in endpoints
    ]
    for thread in threads:
        thread.start()
    try:
        found = serve_duel(SETTINGS, endpoints, lock_step=True)
    finally:
        over.set()
        for thread in threads:
            thread.join(60.0)
    assert not any(thread.is_alive() for thread in threads)
    assert found.run.outcome.value == "completed"
    return found.run.summary.min_distance_m, states


def test_over_ros2_in_lock_step_the_duel_is_the_one_in_one_process(
    distance_without_a_wire: float,
) -> None:
    """Topics carry doubles, without loss."""
    pytest.importorskip("cyclonedds")
    from stepaside.drivers.ros2_dds import DdsParticipant
    from stepaside.drivers.ros2_server import WorldClock
    from stepaside.games.robot_endpoints import Ros2Endpoint

    dds = DdsParticipant(DOMAIN)
    clock = WorldClock(dds)
    endpoints: dict[str, RobotEndpoint] = {
        name: Ros2Endpoint(dds, clock, f"/{name}") for name in ROLES
    }
    least, states = served(endpoints)
    assert least == pytest.approx(distance_without_a_wire, abs=1e-6)
    assert DrivingState.WALKING in states
    dds.close()
