"""Step copies of a recorded duel with MuJoCo Warp, and on processor cores.

Needs ``numpy``, ``mujoco`` and ``mujoco_warp``, none of this package, so that
it runs on any machine with a GPU. ``warp_physics.py`` records the duel and
makes a result of what is measured here::

    python tools/benchmarks/warp_rates.py FOLDER --output measured.json
"""

import gc
import json
import os
from argparse import ArgumentParser
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from time import perf_counter
from traceback import print_exc
from typing import Any, NamedTuple

import mujoco
import mujoco_warp
import numpy as np
import warp
from mujoco.batch import Batch
from numpy.typing import NDArray

Array = NDArray[np.float64]
WORLDS = (1, 64, 512, 2048, 8192)
THREADS = (1, 2, 16)
DUELS_PER_THREAD = 16  # of the measurement on processor cores
ROUNDS = 3  # of the same; the fastest counts
COMPARED = 32  # worlds whose motion is compared
NOISE = 1e-3  # of the joint angles at the beginning, in [rad]
CONTACTS = 32  # room per world; the played duel has at most 16
CONSTRAINTS = 96  # likewise; the played duel has at most 66
WARM_UP = 25  # ticks before times are taken
PARTS = 4  # of a duel, each with its own time


class Recorded(NamedTuple):
    """A duel to repeat.

    Attributes:
        model: Model of both robots.
        state: Full state at the beginning, of ``mjSTATE_INTEGRATION``.
        commands: Targets of the servos in [rad], shape (ticks, servos).
        torsos: Addresses of the torso positions within ``qpos``.
        standing: Lowest torso height of a standing robot, in [m].
        steps: Steps of physics in a tick.
    """

    model: Any
    state: Array
    commands: Array
    torsos: NDArray[np.int64]
    standing: float
    steps: int

    @classmethod
    def read(cls, folder: Path) -> "Recorded":
        """Read what ``warp_physics.py --record`` wrote."""
        model = mujoco.MjModel.from_binary_path(str(folder / "duel.mjb"))
        with np.load(folder / "duel.npz") as rows:
            return cls(
                model,
                rows["state"],
                rows["commands"],
                rows["torsos"],
                float(rows["standing"]),
                int(rows["steps"]),
            )

    @property
    def tick(self) -> float:
        """Length of a tick, in [s]."""
        return float(self.steps * self.model.opt.timestep)

    def beginning(self) -> Any:
        """Return data with the state of the beginning."""
        data = mujoco.MjData(self.model)
        kind = mujoco.mjtState.mjSTATE_INTEGRATION
        mujoco.mj_setState(self.model, data, self.state, kind)
        mujoco.mj_forward(self.model, data)
        return data

    def starts(self, worlds: int) -> Array:
        """Return initial ``qpos`` with noise, shape (worlds, nq).

        World 0 has none.
        """
        hinges = self.model.jnt_type == mujoco.mjtJoint.mjJNT_HINGE
        angles = self.model.jnt_qposadr[hinges]
        qpos = np.tile(self.beginning().qpos, (worlds, 1))
        noise = np.random.default_rng(0).normal(size=(worlds, len(angles)))
        qpos[1:, angles] += NOISE * noise[1:]
        return qpos

    def positions(self, qpos: Array) -> Array:
        """Return torso positions in [m], shape (worlds, robots, 3)."""
        return qpos[:, self.torsos[:, None] + np.arange(3)]

    def standing_share(self, qpos: Array) -> float:
        """Return the share of worlds whose robots all stand."""
        upright = self.positions(qpos)[..., 2] > self.standing
        return float(upright.all(axis=1).mean())


def on_processor(
    recorded: Recorded, duels: int, threads: int
) -> tuple[float, dict[int, Array]]:
    """Step duels with ``mujoco.batch``.

    Returns:
        Wall-clock time in [s], and ``qpos`` of all duels after each part, by
        its last tick.
    """
    batch = Batch(recorded.model, nsim=duels, nthread=threads)
    batch.state[:] = recorded.state
    positions, controls = batch.bind("qpos"), batch.bind("ctrl")
    positions[:] = recorded.starts(duels)
    kept, spent = {}, 0.0
    for ticks in _parts(recorded):
        begin = perf_counter()
        for command in recorded.commands[ticks.start : ticks.stop]:
            controls[:] = command
            batch.step(nstep=recorded.steps)
        spent += perf_counter() - begin
        kept[ticks.stop] = np.array(positions)
    return spent, kept


def processor_rates(recorded: Recorded) -> list[dict[str, float]]:
    """Return simulated seconds per second, by number of threads."""
    rows: list[dict[str, float]] = []
    for threads in THREADS:
        if threads > (os.cpu_count() or 1):
            continue
        duels = threads * DUELS_PER_THREAD
        spent = [
            on_processor(recorded, duels, threads)[0] for _ in range(ROUNDS)
        ]
        length = duels * len(recorded.commands) * recorded.tick
        rows.append(
            {
                "threads": threads,
                "duels": duels,
                "rate": length / min(spent),
                "lowest_rate": length / max(spent),
            }
        )
        print(rows[-1], flush=True)
    return rows


class WarpDuels:
    """Copies of a duel in MuJoCo Warp.

    Attributes:
        data: Their state.
    """

    def __init__(self, recorded: Recorded, worlds: int) -> None:
        """Allocate the worlds.

        Args:
            recorded: The duel.
            worlds: Number of copies.
        """
        self._recorded = recorded
        self._model = mujoco_warp.put_model(recorded.model)
        self._model.opt.warn_overflow = 0  # counted at the end instead
        self._starts = recorded.starts(worlds)
        self.data = mujoco_warp.put_data(
            recorded.model,
            recorded.beginning(),
            nworld=worlds,
            nconmax=CONTACTS,
            njmax=CONSTRAINTS,
        )
        self._warmstart = self.data.qacc_warmstart.numpy()
        self._commands = warp.array(recorded.commands, dtype=float)
        self._rows = [
            warp.array(  # the same command for all worlds
                ptr=self._commands.ptr + tick * self._commands.strides[0],
                dtype=float,
                shape=(worlds, recorded.commands.shape[1]),
                strides=(0, self._commands.strides[1]),
            )
            for tick in range(len(recorded.commands))
        ]
        self._launch: Callable[[], None] = self._step
        self.restart()

    def capture(self) -> None:
        """Make a CUDA graph of the steps of a tick; nothing on processors."""
        self._step()  # loads kernels that are not loaded yet
        if warp.get_device().is_cuda:
            with warp.ScopedCapture() as capture:
                self._step()
            self._launch = lambda: warp.capture_launch(capture.graph)
        self.restart()

    def restart(self) -> None:
        """Return to the beginning."""
        self.data.qpos.assign(self._starts)
        worlds = len(self._starts)
        qvel = np.tile(self._recorded.beginning().qvel, (worlds, 1))
        self.data.qvel.assign(qvel)
        self.data.qacc_warmstart.assign(self._warmstart)
        self.data.time.zero_()
        self.data.overflow.zero_()
        warp.synchronize()

    def _step(self) -> None:
        for _ in range(self._recorded.steps):
            mujoco_warp.step(self._model, self.data)

    def run(self, ticks: range) -> float:
        """Repeat ticks; return the wall-clock time in [s]."""
        begin = perf_counter()
        for tick in ticks:
            warp.copy(self.data.ctrl, self._rows[tick])
            self._launch()
        warp.synchronize()
        return perf_counter() - begin

    def overflows(self) -> list[str]:
        """Return the limits that any world exceeded."""
        found = int(np.bitwise_or.reduce(self.data.overflow.numpy()))
        kinds = mujoco_warp.OverflowType
        return [
            kind.name
            for kind in kinds.__members__.values()
            if kind.value.bit_count() == 1 and found & kind.value
        ]


def warp_rate(
    recorded: Recorded,
    worlds: int,
    seconds: float,
    reference: dict[int, Array],
) -> dict[str, Any]:
    """Measure copies of the duel in MuJoCo Warp.

    Args:
        recorded: The duel.
        worlds: Number of copies.
        seconds: Time after which no further part of the duel begins.
        reference: ``qpos`` of the compared worlds on the processor, by tick.

    Returns:
        Simulated seconds per second and the difference from the processor.
    """
    gc.collect()  # copies measured before
    free, begin = _free_memory(), perf_counter()
    duels = WarpDuels(recorded, worlds)
    duels.capture()
    set_up = perf_counter() - begin
    duels.run(range(min(WARM_UP, len(recorded.commands))))
    duels.restart()
    rates, spent, simulated, compared = [], 0.0, 0.0, {}
    for ticks in _parts(recorded):
        took = duels.run(ticks)
        spent += took
        length = worlds * len(ticks) * recorded.tick
        simulated += length
        rates.append(length / took)
        qpos = duels.data.qpos.numpy().astype(float)
        end = f"{ticks.stop * recorded.tick:.3g}"
        compared[end] = _difference(recorded, qpos, reference[ticks.stop])
        if spent > seconds:
            break
    row = {
        "worlds": worlds,
        "rate": simulated / spent,
        "rates_of_parts": rates,
        "wall_s": spent,
        "set_up_s": set_up,
        "memory_bytes": free - _free_memory(),
        "overflows": duels.overflows(),
        "after": compared,
    }
    print(row, flush=True)
    return row


def _difference(
    recorded: Recorded, qpos: Array, reference: Array
) -> dict[str, float]:
    """Compare the torsos of worlds with those on the processor."""
    worlds = min(len(qpos), len(reference))
    own, other = recorded.positions(qpos), recorded.positions(reference)
    away = np.linalg.norm(own[:worlds] - other[:worlds], axis=-1)
    begin = recorded.positions(recorded.starts(1))
    return {
        "compared": worlds,
        "median_m": float(np.median(away)),
        "greatest_m": float(away.max()),
        "noise_median_m": float(
            np.median(np.linalg.norm(other - other[:1], axis=-1))
        ),
        "moved_m": float(np.linalg.norm(other[0] - begin[0], axis=-1).mean()),
        "standing": recorded.standing_share(qpos),
        "standing_on_processor": recorded.standing_share(reference),
    }


def _parts(recorded: Recorded) -> list[range]:
    """Divide the ticks into parts of equal length."""
    ticks = len(recorded.commands)
    edges = [round(ticks * part / PARTS) for part in range(PARTS + 1)]
    return [
        range(begin, end) for begin, end in zip(edges, edges[1:], strict=False)
    ]


def _free_memory() -> int:
    device = warp.get_device()
    return int(device.free_memory) if device.is_cuda else 0


def measure(
    recorded: Recorded, worlds: list[int], seconds: float
) -> dict[str, Any]:
    """Measure processor and MuJoCo Warp in one process.

    Args:
        recorded: The duel.
        worlds: Numbers of copies.
        seconds: Time for all of them; the last may take a quarter longer.
    """
    warp.config.log_level = warp.LOG_WARNING
    warp.init()
    device = warp.get_device()
    _, reference = on_processor(recorded, COMPARED, os.cpu_count() or 1)
    processor = processor_rates(recorded)
    begin = perf_counter()
    WarpDuels(recorded, 1).capture()  # compiles what is not kept
    loading = perf_counter() - begin
    print(f"kernels loaded in {loading:.1f} s", flush=True)
    rows: list[dict[str, Any]] = []
    begin = perf_counter()
    for number in worlds:
        left = seconds - (perf_counter() - begin)
        if left <= 0.0:
            break
        try:
            rows.append(warp_rate(recorded, number, left, reference))
        except RuntimeError:  # no memory, say
            print_exc()
            break
    return {
        "device": device.name,
        "threads_of_machine": os.cpu_count(),
        "libraries": {
            name: version(name)
            for name in ("mujoco", "mujoco-warp", "warp-lang", "numpy")
        },
        "kernels_s": loading,
        "processor": processor,
        "warp": rows,
    }


def main() -> None:
    """Measure and write the values as JSON."""
    asked = ArgumentParser(description=__doc__)
    asked.add_argument("folder", type=Path, help="folder of the recording")
    asked.add_argument("--output", type=Path, default=Path("measured.json"))
    asked.add_argument("--worlds", type=int, nargs="+", default=WORLDS)
    asked.add_argument("--seconds", type=float, default=120.0)
    arguments = asked.parse_args()
    recorded = Recorded.read(arguments.folder)
    found = measure(recorded, arguments.worlds, arguments.seconds)
    arguments.output.write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
