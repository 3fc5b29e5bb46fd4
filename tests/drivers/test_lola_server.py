"""Test the robot's side of LoLA over sockets of this machine."""

import socket
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from lola_fakes import JOINTS, STANCE, MadeUpRobot
from stepaside.core.errors import ConfigurationError
from stepaside.drivers.guardian_process import SessionLost
from stepaside.drivers.lola.conventions import REAL_TIME
from stepaside.drivers.lola.lola_address import LolaAddress, parse_address
from stepaside.drivers.lola.lola_frames import (
    ActuatorFrame,
    pack_actuators,
    unpack_sensors,
)
from stepaside.drivers.lola.lola_server import LolaServer
from stepaside.drivers.lola.nao_joints import TICK
from stepaside.drivers.lola.served_joints import FADING, SILENT
from stepaside.drivers.lola.sight_socket import MESSAGE, unpack_sight
from stepaside.drivers.lola.socket_link import SocketLink, connect
from stepaside.drivers.lola.wire import SENSOR_BYTES
from stepaside.perception.measurement import Sighting

STIFF = pack_actuators(
    ActuatorFrame(np.concatenate([STANCE, [0, 0]]), np.ones(25))
)


@pytest.fixture
def address(tmp_path: Path) -> LolaAddress:
    return LolaAddress(path=str(tmp_path / "r.sock"))


@pytest.fixture
def served(address: LolaAddress) -> Iterator[tuple[LolaServer, MadeUpRobot]]:
    robot = MadeUpRobot()
    server = LolaServer(address, robot, JOINTS)
    yield server, robot
    server.close()


def call(address: LolaAddress) -> SocketLink:
    return connect(address, SENSOR_BYTES)


def tick(server: LolaServer, link: SocketLink | None, answer: bytes) -> None:
    """One tick, with an answer that comes in time."""
    server.speak()
    if link is not None and answer:
        link.send(answer)
    server.hear()
    server.act()


def test_a_client_gets_896_bytes_each_tick_in_one_piece(
    served: tuple[LolaServer, MadeUpRobot], address: LolaAddress
) -> None:
    server, robot = served
    link = call(address)
    for count in range(5):
        tick(server, link, STIFF)
        (data,) = link.receive()
        frame = unpack_sensors(data)
        assert frame.battery[3] == count
        assert frame.robot_config[0] == REAL_TIME
        np.testing.assert_allclose(frame.position[:23], STANCE, atol=1e-7)
    assert frame.accelerometer[2] == pytest.approx(-9.81)
    link.close()


def test_an_answer_moves_the_robot_in_the_same_tick(
    served: tuple[LolaServer, MadeUpRobot], address: LolaAddress
) -> None:
    server, robot = served
    link = call(address)
    moved = np.concatenate([STANCE + 0.1, [0, 0]])
    tick(server, link, pack_actuators(ActuatorFrame(moved, np.ones(25))))
    np.testing.assert_allclose(robot.angles, STANCE + 0.1, atol=1e-7)
    assert robot.stiffness.tolist() == [1.0] * 23
    link.close()


def test_stiffness_decays_without_answers_and_not_before_100_ms(
    served: tuple[LolaServer, MadeUpRobot], address: LolaAddress
) -> None:
    server, robot = served
    link = call(address)
    tick(server, link, STIFF)
    shares = []
    for _ in range(SILENT + round(FADING / TICK) + 2):
        tick(server, link, b"")
        shares.append(robot.stiffness[0])
    assert shares[: SILENT - 1] == [1.0] * (SILENT - 1)
    assert shares[SILENT] < 1.0 and shares[-1] == 0.0
    assert all(b <= a for a, b in zip(shares, shares[1:], strict=False))
    tick(server, link, STIFF)
    assert robot.stiffness[0] == 1.0
    link.close()


def test_a_second_client_is_refused_and_the_first_goes_on(
    served: tuple[LolaServer, MadeUpRobot], address: LolaAddress
) -> None:
    server, _ = served
    first = call(address)
    tick(server, first, STIFF)
    second = call(address)
    tick(server, first, STIFF)
    assert server.refused == 1 and server.connected
    assert second.wait(1.0)
    with pytest.raises(SessionLost, match="closed the session"):
        second.receive()
    assert len(first.receive()) == 2
    first.close()
    second.close()


@pytest.mark.parametrize("garbage", [b"\xc1", b"\x00", b"\x81\xa1x\x00"])
def test_garbage_ends_the_session_and_not_the_server(
    served: tuple[LolaServer, MadeUpRobot],
    address: LolaAddress,
    garbage: bytes,
) -> None:
    server, robot = served
    link = call(address)
    tick(server, link, STIFF)
    tick(server, link, garbage)
    assert not server.connected
    for _ in range(60):
        tick(server, None, b"")
    assert robot.stiffness.max() == 0.0
    link.close()


def test_a_client_that_does_not_read_is_dropped_and_does_not_block(
    served: tuple[LolaServer, MadeUpRobot], address: LolaAddress
) -> None:
    server, _ = served
    link = call(address)
    for _ in range(2000):
        server.speak()
        if not server.connected:
            break
    assert not server.connected
    link.close()


def test_the_chest_button_is_pressed_by_the_world(
    served: tuple[LolaServer, MadeUpRobot], address: LolaAddress
) -> None:
    server, _ = served
    link = call(address)
    for wanted in (True, False):
        server.press(wanted)
        tick(server, link, STIFF)
        (data,) = link.receive()
        assert unpack_sensors(data).touch[0] == float(wanted)
    link.close()


def test_the_true_line_of_sight_has_a_channel_that_says_so(
    served: tuple[LolaServer, MadeUpRobot], address: LolaAddress
) -> None:
    server, robot = served
    assert address.sight is not None
    assert address.sight.path == address.path + ".ideal-sight"
    sight = connect(address.sight, MESSAGE.size)
    link = call(address)
    robot.sighting = Sighting(0.0, 0.25, 1.1)
    for _ in range(3):
        tick(server, link, STIFF)
    (data,) = sight.receive()  # once, for it is one sighting
    assert unpack_sight(data) == (0, 0.0, 0.25, 1.1)
    robot.sighting = Sighting(robot.time - 0.1, -0.25, 1.0)
    tick(server, link, STIFF)
    (data,) = sight.receive()
    assert unpack_sight(data) == pytest.approx((3, 0.1, -0.25, 1.0))
    sight.close()
    link.close()


def test_sockets_are_taken_away_and_leftovers_replaced(
    address: LolaAddress,
) -> None:
    with socket.socket(socket.AF_UNIX) as left:
        left.bind(address.path)  # as a killed world leaves it
    server = LolaServer(address, MadeUpRobot(), JOINTS)
    with pytest.raises(
        ConfigurationError, match="another program listens there"
    ):
        LolaServer(address, MadeUpRobot(), JOINTS)
    server.close()
    assert not Path(address.path).exists()
    assert not Path(address.path + ".ideal-sight").exists()


def test_a_file_is_not_taken_for_a_socket(address: LolaAddress) -> None:
    Path(address.path).write_text("mine")
    with pytest.raises(ConfigurationError, match="a file of that name"):
        LolaServer(address, MadeUpRobot(), JOINTS)
    assert Path(address.path).read_text() == "mine"


def test_connecting_without_a_robot_fails_at_once(
    address: LolaAddress,
) -> None:
    with pytest.raises(SessionLost, match="no robot listens at .*r.sock"):
        call(address)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("lola:", LolaAddress(path="/tmp/robocup")),
        ("lola:/run/a.sock", LolaAddress(path="/run/a.sock")),
        ("P.sock", LolaAddress(path="P.sock")),
        ("lola:nao.local:10000", LolaAddress(host="nao.local", port=10000)),
        ("127.0.0.1:1", LolaAddress(host="127.0.0.1", port=1)),
        ("/tmp/a:5", LolaAddress(path="/tmp/a:5")),
    ],
)
def test_an_address_is_a_path_or_a_port(
    text: str, wanted: LolaAddress
) -> None:
    assert parse_address(text) == wanted


@pytest.mark.parametrize(
    "text",
    ["lola::5", "lola:host:", "lola:host:x", "h:0", "h:65536", "x" * 99],
)
def test_an_invalid_address_is_refused(text: str) -> None:
    with pytest.raises(ConfigurationError):
        parse_address(text)


def test_a_port_serves_as_a_path_does() -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    address = LolaAddress(host="127.0.0.1", port=port)
    assert address.sight is None
    server = LolaServer(address, MadeUpRobot(), JOINTS)
    link = call(address)
    server.speak()
    assert link.wait(5.0)
    assert len(link.receive()) == 1
    link.close()
    server.close()
