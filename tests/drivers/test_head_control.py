"""Test players that detect the opponent by their robot's camera."""

from math import atan2, hypot
from typing import Any

import numpy as np
import pytest

pytest.importorskip("cv2")

from commanded_robots import VelocityCommands, commanded_robots  # noqa: E402
from stepaside.core.poses import wrap_angle  # noqa: E402
from stepaside.drivers.scheme_factory import perception_factory  # noqa: E402
from stepaside.drivers.velocity.head_control import PERIOD, CameraBody
from stepaside.drivers.velocity.template_controller import TemplateController  # noqa: E402
from stepaside.drivers.velocity.velocity_body import (
    REST,
    VelocityCommand,
    VelocityReport,
)
from stepaside.drivers.velocity.velocity_limits import VelocityLimits  # noqa: E402
from stepaside.drivers.velocity.velocity_loop import VelocityLoop  # noqa: E402
from stepaside.drivers.velocity.watchdog import WatchSettings  # noqa: E402
from stepaside.games.duel_settings import DuelSettings, StartSettings  # noqa: E402
from stepaside.games.match import Match, play  # noqa: E402
from stepaside.games.velocity_walker import VelocityWalker  # noqa: E402
from stepaside.locomotion.zmp.control_settings import STABILISED  # noqa: E402
from stepaside.perception.images import Percept  # noqa: E402
from stepaside.planning import GaitSettings  # noqa: E402
from stepaside.robots.description import load_robot  # noqa: E402
from stepaside.sim.body_settings import BODIES  # noqa: E402
from stepaside.sim.camera_settings import CameraSettings, ColourSettings
from stepaside.strategies import Evasion, Pursuit, Strategy  # noqa: E402

EVERY = 4  # ticks between reports
SETTINGS = DuelSettings(
    seed=7,
    duration=4.0,
    start=StartSettings(0.85, 0.2, 0.1),
    body=BODIES["delayed"],
    control=STABILISED,
    sensing="cameras",
    cameras=CameraSettings(colour=ColourSettings(renderer="raycast")),
)


class NoWire:
    """Player, robot and camera in one process."""

    def __init__(self, robot: VelocityWalker, role: str, plays: Strategy):
        self.robot, self._ticks, self._velocity = robot, 0, REST
        self._told: Any = None
        self.seen: VelocityReport | None = None
        perception = perception_factory(role)(load_robot("nao"), PERIOD)
        self._looking = CameraBody(self, self, perception)
        self.playing = VelocityLoop(
            self._looking,
            lambda: TemplateController(plays, GaitSettings()),
            VelocityLimits(),
            WatchSettings(paced=False),
        )

    @property
    def joints(self) -> Any:
        """As measured."""
        return np.array(self.robot.state().joints)

    def look(self, yaw: float, pitch: float) -> None:
        """Turn the head."""
        self.robot.look({"HeadYaw": yaw, "HeadPitch": pitch})

    def percepts(self, frame: int, now: float, tick: float) -> list[Percept]:
        """The newest image, if it is new."""
        image, before = self.robot.state().image, self._told
        self._told = image
        return [] if image is None or image is before else [image]

    def listen(self, patience: float) -> VelocityReport | None:
        """Own state, without a sighting of the opponent."""
        state = self.robot.state()
        assert state.sighting is None
        return VelocityReport(state.time, state.pose)

    def command(self, velocity: VelocityCommand) -> None:
        """Take what is asked for."""
        self._velocity = velocity

    def act(self) -> VelocityCommand:
        """Command of this tick."""
        if self._ticks % EVERY == 0:
            self.tick = self.playing.tick()
        self._ticks += 1
        return self._velocity

    def close(self) -> None:
        """Nothing to let go of."""


def test_players_with_cameras_detect_each_other_and_walk() -> None:
    world, players = commanded_robots(SETTINGS)
    plays: dict[str, Strategy] = {"pursuer": Pursuit(), "evader": Evasion()}
    wires = {p.name: NoWire(p, p.name, plays[p.name]) for p in players}
    commands = VelocityCommands({p: wires[p.name].act for p in players})
    play(Match(world, players, [commands]), SETTINGS.duration)
    heard = [set(player.state().echoes) for player in players]
    assert heard == [set(), {"left", "right"}]  # the evader has sonars
    one, other = (player.truth for player in players)
    for own, seen, name in ((one, other, "pursuer"), (other, one, "evader")):
        tick = wires[name].tick
        assert abs(tick.velocity.forward) > 0.05, name
        assert tick.sighting is not None
        x, y = own.position_reference_in_world
        u, v = seen.position_reference_in_world
        toward = wrap_angle(atan2(v - y, u - x) - own.heading_in_world)
        off = wrap_angle(tick.sighting.bearing - toward)
        assert abs(off) < 0.1, name
        assert abs(tick.sighting.distance - hypot(u - x, v - y)) < 0.1, name


def test_the_head_of_a_robot_on_naoqi_turns_and_nothing_else() -> None:
    pytest.importorskip("qi")
    from naoqi_fakes import heard
    from stepaside.drivers.guardian_process import SessionLost
    from stepaside.drivers.naoqi.naoqi_body import NaoqiBody
    from stepaside.drivers.naoqi.naoqi_server import NaoqiServer
    from stepaside.drivers.naoqi.qi_session import ask, connect
    from velocity_fakes import SimulatedUnicycle, until

    walker = SimulatedUnicycle()
    names = ["HeadYaw", "HeadPitch"]
    place = "tcp://127.0.0.1:0"
    server = NaoqiServer(
        place, walker, names, VelocityCommand(1, 1), tick=0.012
    )

    def turned() -> Any:
        server.speak()
        server.act()
        return walker.head

    session = connect(server.url)
    motion = session.service("ALMotion")
    body = NaoqiBody(server.url, joint_names=names)
    try:
        assert heard(body).pose == pytest.approx(walker.pose)
        assert body.joints.tolist() == [0.1, 0.2]
        until(lambda: heard(body).hindrance == "")
        body.look(0.5, -0.2)
        until(turned)
        assert walker.head == {"HeadYaw": 0.5, "HeadPitch": -0.2}
        for bad in (
            (["LKneePitch"], [0.1], 0.3),
            ("HeadYaw", float("nan"), 0.3),
            ("HeadYaw", 0.1, 0.0),
        ):
            with pytest.raises(SessionLost):
                ask(motion, "setAngles", *bad, within=5.0)
        assert turned() == {"HeadYaw": 0.5, "HeadPitch": -0.2}
    finally:
        body.close()
        session.close()
        server.close()
