"""Test duels with control over sockets against duels in one process."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Thread

import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.drivers.joint_loop import JointLoop
from stepaside.drivers.lola import LolaRobot
from stepaside.drivers.method_thread import SessionLost
from stepaside.drivers.motors import motors_of
from stepaside.drivers.play_log import PlayTick
from stepaside.drivers.robot_session import RobotSession
from stepaside.drivers.safety import SafetyState
from stepaside.drivers.scheme_factory import scheme_factory
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.recorded_game import run_duel
from stepaside.games.run import Run
from stepaside.games.run_archive import load_run, results_of
from stepaside.games.served_duel import lola_endpoint, serve_duel
from stepaside.locomotion.control_settings import ControlSettings
from stepaside.planning import GaitSettings
from stepaside.report.run_folder import write_run
from stepaside.report.scene import RunScene
from stepaside.robots.description import load_robot
from stepaside.sim.body_settings import BODIES
from stepaside.strategies import Evasion, Pursuit, Strategy
from synthetic_run import check_same

FEEDBACK = ControlSettings(method="measured", feedback=True)


def client(
    path: Path,
    strategy: Strategy,
    ticks: list[PlayTick],
) -> None:
    """Play one player until its robot disconnects."""
    robot, nao = LolaRobot(str(path)), load_robot("nao")
    make = scheme_factory(nao, GaitSettings(), FEEDBACK, tick=0.012)
    while not path.exists():
        pass  # the world is being built
    playing = JointLoop(
        lambda: RobotSession(robot), motors_of(robot, nao), strategy, make
    )
    try:
        while True:
            ticks.append(playing.tick())
    except SessionLost:
        playing.close()


@contextmanager
def clients(
    folder: Path,
) -> Iterator[tuple[dict[str, Path], list[PlayTick]]]:
    addresses = {name: folder / name for name in ("pursuer", "evader")}
    roles = {"pursuer": Pursuit(), "evader": Evasion()}
    ticks: list[PlayTick] = []
    threads = [
        Thread(target=client, args=(addresses[n], roles[n], ticks))
        for n in addresses
    ]
    for thread in threads:
        thread.start()
    try:
        yield addresses, ticks
    finally:
        for thread in threads:
            thread.join(60.0)
        assert not any(thread.is_alive() for thread in threads)


def test_in_lock_step_the_duel_is_the_one_played_in_one_process(
    tmp_path: Path,
) -> None:
    """Up to the single precision of the wire format."""
    settings = DuelSettings(
        seed=7,
        duration=3.0,
        start=StartSettings(0.75, 0.2, 0.1),
        body=BODIES["delayed"],
        control=FEEDBACK,
    )
    with clients(tmp_path) as (addresses, ticks):
        endpoints = {
            name: lola_endpoint(str(path)) for name, path in addresses.items()
        }
        over = serve_duel(settings, endpoints, lock_step=True)
    served, played = over.to_json(), run_duel(settings)
    alone = results_of(played)
    check_record(over.run, played, tmp_path / "kept")
    assert served["outcome"] == alone["outcome"] == "completed"
    assert served["duration_s"] == alone["duration_s"]
    for key in ("distance_m", "min_distance_m"):
        assert abs(served[key] - alone[key]) < 1e-3
    # Seen from outside a step begins when the joints move.
    late = served["triggered_at_s"] - alone["triggered_at_s"]
    assert 0.0 <= late < 1.0
    assert served["late_ticks"] == 0
    walked = [t for t in ticks if t.state is SafetyState.WALKING]
    assert max(t.time for t in walked) >= 249 * 0.012 - 1e-9
    assert not any(a.exists() for a in addresses.values())


def check_record(served: Run, played: Run, folder: Path) -> None:
    """Check that the record is complete except for plans."""
    assert served.settings == played.settings
    np.testing.assert_array_equal(served.times, played.times)
    for name, track in served.tracks.items():
        for key in ("com", "torso", "place", "qpos"):
            wanted = getattr(played.tracks[name], key)
            found = getattr(track, key)
            np.testing.assert_allclose(found, wanted, atol=2e-3)
        assert track.zmp is not None and track.com_reference is None
    write_run(folder, served)
    check_same(load_run(folder), served)
    RunScene(served).put(len(served.times) - 1)


def test_the_wait_for_clients_is_limited(
    tmp_path: Path,
) -> None:
    endpoints = {"evader": lola_endpoint(str(tmp_path / "e"))}
    settings = DuelSettings(body=BODIES["delayed"])
    with pytest.raises(ConfigurationError, match="1 of 1 robots had no"):
        serve_duel(settings, endpoints, patience=0.02)
    assert list(tmp_path.iterdir()) == []


def test_a_duel_with_another_tick_is_not_served(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match="tick of 0.012"):
        endpoints = {"evader": lola_endpoint(str(tmp_path / "e"))}
        serve_duel(DuelSettings(), endpoints)
