"""The door of the page's server, from outside."""

import socket
import time
from collections.abc import Iterator
from typing import Any

import msgspec
import pytest

viser = pytest.importorskip("viser")

from click.testing import CliRunner  # noqa: E402
from websockets.exceptions import (  # noqa: E402
    ConnectionClosed,
    InvalidStatus,
)
from websockets.sync.client import connect  # noqa: E402

from stepaside.cli.main import main  # noqa: E402
from stepaside.core.errors import ConfigurationError  # noqa: E402
from stepaside.report.viewer import access_control as gates  # noqa: E402
from stepaside.report.viewer.access_control import AccessControl  # noqa: E402
from stepaside.report.viewer.page_address import PageAddress, listen  # noqa: E402
from stepaside.report.viewer.page_messages import MAX_SIZE  # noqa: E402
from stepaside.report.viewer.page_server import PageServer, open_server  # noqa: E402

PROTOCOL: Any = [f"viser-v{viser.__version__}"]


@pytest.fixture(scope="module")
def served() -> Iterator[PageServer]:
    opened = open_server("127.0.0.1", 8790)
    yield opened
    opened.server.stop()


@pytest.fixture(scope="module")
def abroad() -> Iterator[PageServer]:
    opened = open_server("0.0.0.0", 8890)
    yield opened
    opened.server.stop()


def ask(port: int, path: str = "/", *headers: str) -> str:
    """First line and headers of the answer to a plain request."""
    with socket.create_connection(("127.0.0.1", port), 10) as sock:
        lines = [f"GET {path} HTTP/1.1", *headers, "", ""]
        sock.sendall("\r\n".join(lines).encode())
        answer = b""
        while b"\r\n\r\n" not in answer and (more := sock.recv(4096)):
            answer += more
    return answer.decode("latin-1")


def port_of(served: PageServer) -> int:
    return served.gate.address.port


def plug(served: PageServer, origin: str | None, path: str = "") -> Any:
    """Socket of a client with this origin."""
    return connect(
        f"ws://127.0.0.1:{port_of(served)}{path}",
        origin=origin,  # type: ignore[arg-type]
        subprotocols=PROTOCOL,
        proxy=None,
    )


def own(served: PageServer) -> str:
    return f"http://127.0.0.1:{port_of(served)}"


def send(connection: Any, kind: str, **values: Any) -> None:
    connection.send(msgspec.msgpack.encode({"type": kind, **values}))


def until(true: Any) -> None:
    for _ in range(2000):
        if true():
            return
        time.sleep(0.005)
    raise AssertionError("it did not happen")


def test_who_knocks_with_nonsense_leaves_no_word(
    served: PageServer, caplog: pytest.LogCaptureFixture
) -> None:
    for raw in (b"\r\n\r\n", b"\xff" * 90 + b"\n", b"GET / HTTP/1.1\n"):
        with socket.create_connection(("127.0.0.1", port_of(served)), 9) as s:
            s.sendall(raw)
            s.shutdown(socket.SHUT_WR)
            while s.recv(4096):
                pass
    assert not caplog.records


@pytest.mark.parametrize("name", ["127.0.0.1", "localhost", "LOCALHOST"])
def test_the_page_is_served_under_its_names(
    served: PageServer, name: str
) -> None:
    answer = ask(port_of(served), "/", f"Host: {name}:{port_of(served)}")
    assert answer.startswith("HTTP/1.1 200")
    assert "frame-ancestors 'none'" in answer


@pytest.mark.parametrize(
    "host",
    [
        *("evil.example", "evil.example:8790", "localhost.evil.example"),
        *("127.0.0.1.evil.example", "127.0.0.1@evil.example", "", "a b"),
        *("evil.example@127.0.0.1", "127.0.0.1/x", "[::1", "127.0.0.1:x"),
        *("192.168.0.1", "0.0.0.0", "localhost.", "\xff", "127.1"),
    ],
)
def test_another_name_is_refused(served: PageServer, host: str) -> None:
    assert ask(port_of(served), "/", f"Host: {host}")[9:12] in ("403", "")


def test_a_request_has_one_name(served: PageServer) -> None:
    port = port_of(served)
    assert ask(port)[9:12] == "403"
    two = (f"Host: 127.0.0.1:{port}", "Host: evil.example")
    assert ask(port, "/", *two)[9:12] == "403"


@pytest.mark.parametrize(
    "origin",
    [
        *("http://evil.example", "null", "", None, "https://127.0.0.1:{p}"),
        *("http://127.0.0.1", "http://127.0.0.1:1", "http://localhost:{p}"),
        *("file://", "http://127.0.0.1:{p}.evil.example"),
    ],
)
def test_a_socket_of_elsewhere_is_refused(
    served: PageServer, origin: str | None
) -> None:
    said = origin and origin.format(p=port_of(served))
    with pytest.raises(InvalidStatus) as refused, plug(served, said):
        pass
    assert refused.value.response.status_code == 403


def test_a_control_takes_its_own_values_alone(served: PageServer) -> None:
    gui = served.server.gui
    told: list[Any] = []
    refused: list[str] = []
    served.messages.watch(gui, served.server.scene, refused.append)
    speed = gui.add_dropdown("Speed", ("1", "2"))
    gain = gui.add_number("Gain", 1.5, min=0.0, max=9.0)
    seed = gui.add_number("Seed", 1)
    dark = gui.add_checkbox("Dark", False)
    slider = gui.add_slider("Time", 0.0, 9.0, 0.1, 0.0)
    turn = gui.add_button_group("Turn", ("left", "right"))
    button = gui.add_button("Push")
    controls: list[Any] = [speed, gain, seed, dark, slider, turn]
    for each in controls[:-1]:
        each.on_update(lambda event: told.append(event.target.value))
    before = [each.value for each in controls]
    wrong: list[tuple[Any, list[Any]]] = [
        (speed, ["0", 1, None, ["1"], "", "1e9", True]),
        (gain, [1e300, -1.0, 10.0, "1", None, True, float("nan")]),
        (gain, [float("inf"), [], {}, 10**15]),
        (seed, [1.5, "7", 2e9, True, None]),
        (dark, [1, "true", None, []]),
        (slider, [10.0, -0.1, float("nan"), "3"]),
        (turn, ["up", 1, None]),
        (button, [1, "x", None]),
    ]
    count = 0
    with plug(served, own(served)) as connection:
        for control, values in wrong:
            uuid = control._impl.uuid
            for value in values:
                updates = {"value": value}
                send(
                    connection, "GuiUpdateMessage", uuid=uuid, updates=updates
                )
                count += 1
        uuid = gain._impl.uuid
        odd: tuple[Any, ...] = (
            *({"update_cb": []}, {"value": 2.0, "removed": True}, {}, [], 1),
            *({"_impl": 1}, {"props": {}}, {"label": "owned"}),
        )
        for updates in odd:
            send(connection, "GuiUpdateMessage", uuid=uuid, updates=updates)
        for kind in ("ShareUrlRequest", "FileTransferStartUpload", "Message"):
            send(connection, kind)
        send(connection, "GuiUpdateMessage", uuid=[], updates={"value": 1})
        send(connection, "GuiUpdateMessage", uuid="no", updates={"value": 1})
        for raw in (b"", b"\xc1", b"\x91" * 60_000, b"\x93\x01", "text"):
            connection.send(raw)
        send(connection, "GuiUpdateMessage", uuid=uuid, updates={"value": 2.5})
        until(lambda: gain.value == 2.5)
    assert count == 37
    assert [each.value for each in controls] == [before[0], 2.5, *before[2:]]
    assert len(refused) == count + 6
    assert "invalid value for Speed" in refused
    assert gain.label == "Gain"


def test_a_message_that_is_too_long_ends_the_connection(
    served: PageServer,
) -> None:
    with plug(served, own(served)) as connection:
        connection.send(b"\xc4" * (MAX_SIZE + 1))
        with pytest.raises(ConnectionClosed) as closed:
            while True:
                connection.recv(timeout=200)
    assert closed.value.rcvd is not None and closed.value.rcvd.code == 1009


def test_so_many_pages_are_open_and_no_more(
    served: PageServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(gates, "MAX_CLIENTS", 2)
    until(lambda: served.gate.connected == 0)
    with plug(served, own(served)), plug(served, own(served)):
        until(lambda: served.gate.connected == 2)
        with plug(served, own(served)) as third:
            with pytest.raises(ConnectionClosed) as closed:
                third.recv(timeout=200)
            assert closed.value.rcvd is not None
            assert closed.value.rcvd.code == 1013
    until(lambda: served.gate.connected == 0)
    with plug(served, own(served)) as again:
        again.recv(timeout=200)


def test_beyond_this_machine_the_link_holds_a_secret(
    abroad: PageServer,
) -> None:
    port, secret = port_of(abroad), abroad.gate.secret
    host = f"Host: 127.0.0.1:{port}"
    assert len(secret) >= 32
    assert abroad.gate.link == f"http://127.0.0.1:{port}/{secret}/"
    assert ask(port, f"/{secret}/", host)[9:12] == "200"
    assert ask(port, f"/{secret}", host)[9:12] == "200"
    for path in ("/", f"/{secret[:-1]}/", f"/x/{secret}", "/?" + secret):
        assert ask(port, path, host)[9:12] == "403"
        with pytest.raises(InvalidStatus), plug(abroad, own(abroad), path):
            pass
    assert ask(port, f"/{secret}/../x", host)[9:12] in ("403", "404")
    with plug(abroad, own(abroad), f"/{secret}") as connection:
        connection.recv(timeout=200)


def test_everywhere_is_known_by_its_numbers_but_by_no_name() -> None:
    with socket.socket() as sock:
        place = PageAddress(sock, "0.0.0.0", "0.0.0.0", 80)
        assert place.answers_to("192.168.0.7") and place.answers_to("::1")
        assert place.answers_to("localhost")
        assert not place.answers_to("evil.example")
        assert not place.answers_to("")
        one = PageAddress(sock, "192.168.0.7", "192.168.0.7", 80)
        assert one.answers_to("192.168.0.7")
        assert not one.answers_to("192.168.0.8")
        assert AccessControl(one).secret and AccessControl(place).secret
        here = PageAddress(sock, "::1", "::1", 80)
        assert here.url == "http://[::1]:80" and not AccessControl(here).secret


def test_an_occupied_port_is_left_to_its_owner(
    served: PageServer,
) -> None:
    other = listen("127.0.0.1", port_of(served))
    with other.listening:
        assert port_of(served) < other.port < port_of(served) + 100


HOSTS = ("999.1.1.1", "nan", "-1", "", " ", "no.such.invalid", "a b")
ODD = ("x" * 300, "é" * 70, "1", "256.0.0.1", "8.8.8.8", "\x1b[2J", "a\0b")


@pytest.mark.parametrize("host", [*HOSTS, *ODD])
def test_a_host_that_is_none_is_refused_in_one_line(host: str) -> None:
    arguments = ["view", "--host", host, "--no-open", "--serve-for", "0.01"]
    result = CliRunner().invoke(main, arguments)
    assert result.exit_code == 2, result.output
    assert result.output.count("\n") == 1 and "host must" in result.output


def test_a_viser_that_starts_otherwise_is_not_let_serve(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    class Other:
        def __init__(self, **options: Any) -> None:
            self.stopped = False

        def stop(self) -> None:
            stopped.append(True)

    stopped: list[bool] = []
    monkeypatch.setattr(viser, "ViserServer", Other)
    with pytest.raises(ConfigurationError, match="access can be"):
        open_server("127.0.0.1", 8795)
    assert stopped == [True]
