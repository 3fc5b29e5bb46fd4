"""Test the pieces of a live duel, and the programs that show them."""

import json
import socket
import struct
from threading import RLock
from time import monotonic, sleep
from typing import Any

import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.games.duel import Duel
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.report.export.live_recording import (
    LivePiece,
    LiveRecorder,
    LiveStreams,
)

SETTINGS = DuelSettings(
    seed=7, start=StartSettings(0.75, 0.3, 0.2), duration=60.0
)
LONGEST = 60.0  # for what takes seconds on an idle machine, in [s]


@pytest.fixture
def live() -> tuple[Duel, LiveRecorder]:
    """A duel with an observer."""
    recorder = LiveRecorder()
    return Duel(SETTINGS, (recorder,)), recorder


def played(duel: Duel, recorder: LiveRecorder, ticks: int) -> LivePiece:
    """Play on, and return the piece."""
    for _ in range(ticks):
        duel.tick()
    piece = recorder.take()
    assert piece is not None
    return piece


def test_pieces_hold_each_sample_and_each_landing_once(
    live: tuple[Duel, LiveRecorder],
) -> None:
    duel, recorder = live
    assert recorder.take() is None
    pieces = [played(duel, recorder, 97) for _ in range(8)]
    assert [piece.begins for piece in pieces] == [True] + [False] * 7
    runs = [piece.recording.run for piece in pieces]
    times = np.concatenate([run.times for run in runs])
    whole = duel.recorder.tracks()
    np.testing.assert_array_equal(times, duel.recorder.times)
    for name, track in whole.items():
        parts = [run.tracks[name] for run in runs]
        qpos = np.concatenate([part.qpos for part in parts])
        np.testing.assert_array_equal(qpos, track.qpos)
        landed = np.concatenate([part.landings for part in parts])
        assert track.landings is not None
        past = track.landings[:, 0] <= times[-1] - 0.1
        assert len(landed) >= past.sum() > 3
        np.testing.assert_array_equal(landed, track.landings[: len(landed)])
        signals = [piece.recording.signals[name] for piece in pieces]
        forces = np.concatenate([each.foot_forces for each in signals])
        assert forces.shape == (len(times), 8)


def test_another_duel_begins_anew(live: tuple[Duel, LiveRecorder]) -> None:
    duel, recorder = live
    played(duel, recorder, 50)
    again = Duel(SETTINGS, (recorder,))
    piece = played(again, recorder, 50)
    assert piece.begins
    assert piece.recording.run.times[0] == 0.0


class Collector:
    """Program that collects pieces, and fails at the first."""

    def __init__(self) -> None:
        self.pieces: list[LivePiece] = []

    def show(self, piece: LivePiece) -> None:
        """Collect it."""
        self.pieces.append(piece)
        if piece.begins:
            raise RuntimeError("no viewer")

    def close(self) -> None:
        """Nothing to close."""


def test_a_program_that_fails_does_not_stop_the_duel(
    live: tuple[Duel, LiveRecorder],
) -> None:
    duel, recorder = live
    lock, sink = RLock(), Collector()
    streams = LiveStreams(recorder, lock, [sink])
    deadline = monotonic() + LONGEST
    while len(sink.pieces) < 3:
        assert monotonic() < deadline
        with lock:
            duel.tick()
        sleep(0.001)
    streams.close()


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port: int = free.getsockname()[1]
    return port


def test_foxglove_receives_the_messages_of_a_bag(
    live: tuple[Duel, LiveRecorder],
) -> None:
    """A client that subscribes late gets the URDF, too."""
    pytest.importorskip("foxglove", reason="Foxglove's SDK is not installed")
    client = pytest.importorskip("websockets.sync.client")
    from rosbags.typesys import Stores, get_typestore

    from stepaside.report.export.live_foxglove import LiveFoxglove

    sink = LiveFoxglove(free_port())
    duel, recorder = live
    sink.show(played(duel, recorder, 50))
    protocol = ["foxglove.sdk.v1"]
    found: dict[str, tuple[str, bytes]] = {}
    topics: dict[int, Any] = {}
    wanted = {"/tf", "/tf_static", "/evader/robot_description", "/distance_m"}
    with client.connect(sink.address, subprotocols=protocol) as link:
        deadline = monotonic() + LONGEST
        while not wanted <= found.keys():
            assert monotonic() < deadline
            sink.show(played(duel, recorder, 10))
            try:
                message = link.recv(timeout=0.05)
            except TimeoutError:
                continue
            if isinstance(message, str):
                channels = json.loads(message).get("channels", ())
                topics |= {each["id"]: each for each in channels}
                ids = [{"id": i, "channelId": i} for i in topics]
                order = {"op": "subscribe", "subscriptions": ids}
                link.send(json.dumps(order))
            elif message[0] == 1:
                number, _ = struct.unpack("<IQ", message[1:13])
                entry = topics[number]
                found[entry["topic"]] = entry["schemaName"], message[13:]
    sink.close()
    store = get_typestore(Stores.ROS2_HUMBLE)
    kind, data = found["/tf"]
    (frame, *_) = store.deserialize_cdr(data, kind).transforms  # type: ignore[attr-defined]
    assert frame.child_frame_id == "pursuer/base_footprint"
    kind, data = found["/evader/robot_description"]
    urdf = store.deserialize_cdr(data, kind).data  # type: ignore[attr-defined]
    assert 'robot name="nao"' in urdf


def test_rerun_is_served(live: tuple[Duel, LiveRecorder]) -> None:
    pytest.importorskip("rerun", reason="Rerun is not installed")
    from stepaside.report.export.live_rerun import LiveRerun

    sink = LiveRerun(free_port())
    assert sink.address.startswith("rerun+http://127.0.0.1:")
    duel, recorder = live
    for _ in range(3):
        sink.show(played(duel, recorder, 50))
    sink.show(played(Duel(SETTINGS, (recorder,)), recorder, 50))
    sink.close()


@pytest.mark.parametrize("name", ["foxglove", "rerun"])
def test_a_port_in_use_is_refused(name: str) -> None:
    pytest.importorskip(name, reason=f"{name} is not installed")
    from stepaside.report.export.live_foxglove import LiveFoxglove
    from stepaside.report.export.live_rerun import LiveRerun

    kind: Any = {"foxglove": LiveFoxglove, "rerun": LiveRerun}[name]
    with socket.create_server(("127.0.0.1", 0)) as taken:
        with pytest.raises(ConfigurationError, match="cannot be served"):
            kind(taken.getsockname()[1])
