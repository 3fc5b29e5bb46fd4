"""Test the commands ``serve`` and ``play`` on the command line."""

import json
from pathlib import Path
from select import select
from threading import Thread
from time import monotonic, sleep

import numpy as np
import pytest

from lola_fakes import JOINTS, STANCE, MadeUpRobot
from stepaside.cli.main import main
from stepaside.drivers.lola.lola_address import LolaAddress
from stepaside.drivers.lola.lola_server import LolaServer


def refused(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    """Return the message for invalid arguments."""
    with pytest.raises(SystemExit) as left:
        main(list(words))
    assert left.value.code == 2
    (said,) = capsys.readouterr().err.strip().splitlines()
    assert said.startswith("stepaside: ")
    return said


def test_a_robot_that_is_not_there_is_said_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    place = f"lola:{tmp_path}/none"
    said = refused(
        capsys, "play", "--role", "evader", "--robot", place, "--wait", "0"
    )
    assert "no robot listens at" in said and "none" in said


def test_a_robot_that_is_no_address_is_refused(
    capsys: pytest.CaptureFixture[str],
) -> None:
    said = refused(capsys, "play", "--role", "evader", "--robot", "lola::5")
    assert "lola:PATH or lola:HOST:PORT" in said


@pytest.mark.parametrize(
    "lola", [["referee=R"], ["evader"], ["evader=E", "evader=F"]]
)
def test_an_invalid_player_is_not_served(
    lola: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    words = [word for entry in lola for word in ("--lola", entry)]
    assert "pursuer or evader=ADDRESS" in refused(capsys, "serve", *words)


def test_a_world_without_clients_gives_up(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    place = f"evader={tmp_path}/e"
    said = refused(capsys, "serve", "--lola", place, "--wait", "0.05")
    assert "no client that was ready within 0.05 s" in said


@pytest.mark.parametrize("sight", [True, False])
def test_play_waits_for_a_robot_that_is_not_there_yet(
    sight: bool, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """As three background jobs need it, in whatever order they begin."""
    caplog.set_level("INFO")
    place = tmp_path / "late"
    ended: list[object] = []

    def play() -> None:
        words = ["play", "--role", "evader", "--robot", f"lola:{place}"]
        with pytest.raises(SystemExit) as left:
            main([*words, "--dry-run", "--wait", "60"])
        ended.append(left.value.code)

    player = Thread(target=play)
    player.start()
    until = monotonic() + 60.0
    while "retrying for up to 60 s" not in caplog.text and monotonic() < until:
        sleep(0.05)
    assert f"no robot listens at {place}" in caplog.text
    server = LolaServer(
        *(LolaAddress(str(place)), MadeUpRobot(), JOINTS),
        lock_step=True,
        ideal_sight=sight,
    )
    try:
        while not server.connected and player.is_alive():
            server.speak()
            sleep(0.01)
        assert server.connected and not ended
    finally:
        server.close()
        player.join(30.0)
    assert ("uses the ideal line of sight" in caplog.text) == sight


def test_play_waits_no_longer_than_its_timeout(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["play", "--role", "evader", "--robot", f"lola:{tmp_path}/none"]
    began = monotonic()
    with pytest.raises(SystemExit) as left:
        main([*words, "--wait", "0.5"])
    assert left.value.code == 2
    assert 0.5 < monotonic() - began < 20.0
    assert "no robot listens at" in capsys.readouterr().err


def test_a_dry_run_records_without_commands(
    tmp_path: Path,
) -> None:
    place, log = tmp_path / "e", tmp_path / "log"
    robot = MadeUpRobot()
    server = LolaServer(LolaAddress(str(place)), robot, JOINTS, lock_step=True)

    def play() -> None:
        words = ["play", "--role", "evader", "--robot", f"lola:{place}"]
        with pytest.raises(SystemExit):
            main([*words, "--record", str(log), "--dry-run"])

    player = Thread(target=play)
    player.start()
    try:
        while server.count < 50 and player.is_alive():
            server.speak()
            while not server.hear():
                select([server], [], [], 10.0)
            server.act()
    finally:
        server.close()
        player.join(60.0)
    assert not player.is_alive()
    assert robot.stiffness.max() == 0.0
    np.testing.assert_array_equal(robot.angles, STANCE)
    words = json.loads((log / "play.json").read_text())
    assert words["role"] == "evader" and words["dry_run"]
    states = [change["state"] for change in words["changes"]]
    assert states[:2] == ["limp", "reaching"]


def test_a_session_that_is_lost_is_got_again_for_a_while(
    tmp_path: Path,
) -> None:
    """It begins limp, as the first did, and waits for the button."""
    place, log = tmp_path / "e", tmp_path / "log"
    address = LolaAddress(str(place))

    def play() -> None:
        words = ["play", "--role", "evader", "--robot", f"lola:{place}"]
        words += ["--record", str(log), "--reconnect", "2"]
        with pytest.raises(SystemExit):
            main([*words, "--dry-run"])

    player = Thread(target=play)
    player.start()
    for _ in range(2):
        server = LolaServer(address, MadeUpRobot(), JOINTS, lock_step=True)
        while server.count < 30 and player.is_alive():
            server.speak()
            while not server.hear():
                select([server], [], [], 10.0)
            server.act()
        assert server.count == 30
        server.close()
    player.join(60.0)
    assert not player.is_alive()
    words = json.loads((log / "play.json").read_text())
    states = [change["state"] for change in words["changes"]]
    assert states == 2 * ["limp", "reaching", "ready"]
