"""Evaluation of a walking policy at its control period."""

from collections.abc import Sequence
from math import cos, pi, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.compilation import bound, compiled
from ...core.poses import Array
from .contract import PolicyContract
from .network import Memory, PolicyNetwork

STANDS_BELOW = 0.01  # magnitude of a command that counts as zero


@compiled
def observe(
    positions: Array,
    rates: Array,
    spin: Array,
    up: Array,
    velocity: Array,
    wanted: Array,
    joints: NDArray[np.int_],
    posture: Array,
    values: Array,
    phases: Array,
    offsets: Array,
    clock: Array,
    order: NDArray[np.int_],
    clips: Array,
    scales: Array,
    frame: Array,
) -> None:
    """Set the frame that a network observes, and its clock."""
    still = 1.0
    for i in range(3):
        values[i], values[3 + i], values[6 + i] = velocity[i], spin[i], -up[i]
        change = wanted[i] - values[9 + i]
        values[9 + i] += min(max(change, -clock[0]), clock[0])
        still = still if abs(values[9 + i]) < STANDS_BELOW else 0.0
    clock[5] = still * (clock[5] + 1.0)
    stands = 1.0 if clock[5] > clock[6] else 0.0
    seen = 1.0 - clock[3] * stands
    n = posture.shape[0]
    for j in range(n):
        values[12 + j] = positions[joints[j]] - posture[j]
        values[12 + n + j] = rates[joints[j]]
    for k in range(phases.shape[0]):
        phase = phases[k] + clock[1] + pi
        phase = phase if phase < 2.0 * pi else phase - 2.0 * pi
        phase -= pi
        if clock[2] > 0.0 and stands > 0.0:
            phase = pi
        elif clock[2] > 0.0 and clock[4] > 0.0:
            phase = offsets[k]
        phases[k] = phase
        at = 12 + 3 * n + k
        values[at] = seen * sin(phase)
        values[at + phases.shape[0]] = seen * cos(phase)
    clock[4] = stands
    for i in range(order.shape[0]):
        value = values[order[i]]
        frame[i] = min(max(value, -clips[i]), clips[i]) * scales[i]


@compiled
def act(
    raw: Array,
    posture: Array,
    scales: Array,
    limits: Array,
    actions: Array,
    targets: Array,
    frequency: Array,
    clock: Array,
) -> None:
    """Set the targets by the output of a network, and its clock."""
    n = posture.shape[0]
    for j in range(n):
        clipped = min(max(raw[j], -limits[0]), limits[0])
        actions[j] = clipped if limits[2] > 0.0 else raw[j]
        target = posture[j] + scales[j] * clipped
        mixed = limits[1] * targets[j] + (1.0 - limits[1]) * target
        targets[j] = mixed if limits[1] > 0.0 else target
    if limits[3] > 0.0:
        frequency[0] = min(max(raw[n], -limits[0]), limits[0])
        change = min(max(frequency[0], -limits[3]), limits[3])
        clock[1] = limits[4] + limits[5] * change


class BodyMotion(NamedTuple):
    """Arrays of what a policy observes, read at each of its periods."""

    joint_positions: Array  # angles of all joints [rad]
    joint_velocities: Array  # their velocities [rad/s]
    angular_velocity: Array  # of the torso in its frame [rad/s]. Shape (3,)
    up: Array  # upward unit vector in the torso frame. Shape (3,)
    velocity: Array  # of the torso in its frame [m/s]. Shape (3,)
    command: Array  # [m/s] [rad/s] (3,)


class PolicyRunner:
    """Policy with its clock, history and previous action."""

    def __init__(
        self,
        contract: PolicyContract,
        network: PolicyNetwork,
        motion: BodyMotion,
        joints: Sequence[int],
    ) -> None:
        """Begin standing in the default posture."""
        self.contract, self.memory = contract, network.initial_memory()
        posture = np.array(contract.default_posture, dtype=np.float64)
        self.targets = posture.copy()  # [rad] (joints,)
        layout, clock = ObservationLayout.of(contract), contract.clock
        values, self._raw = (
            np.zeros(layout.size),
            np.zeros(contract.action_width),
        )
        gait = np.array(clock_values(contract))
        self._history: Array | None = None
        self._flat, self._frame = layout.flat, np.zeros(layout.order.size)
        offsets = np.array(() if clock is None else clock.offsets, dtype=float)
        self.loop = bound(
            *(observe, *motion, np.array(joints, dtype=np.int64), posture),
            *(values, offsets.copy(), offsets),
            gait,
            *(layout.order, layout.clips, layout.scales, self._frame),
        )
        self._act = bound(
            *(
                act,
                self._raw,
                posture,
                np.array(contract.action_scale, dtype=float),
            ),
            np.array(action_limits(contract)),
            *(values[layout.places["actions"]], self.targets),
            *(values[layout.places["frequency"]], gait),
        )

    def observation(self) -> Array:
        """Return the input of the network; it changes with the next one.

        Shape (observation width,).
        """
        frame, count = self._frame, self.contract.history
        if count == 1:
            return frame
        if self._history is None:
            self._history = np.tile(frame, (count, 1))
        self._history[:-1] = self._history[1:]
        self._history[-1] = frame
        found: Array = self._history.ravel().take(self._flat)
        return found

    def act(self, raw: Array, memory: Memory) -> Array:
        """Update the targets by the output of the network.

        ``raw``: Output of the network. Shape (action width,). The targets, in
        [rad]. Shape (joints,).
        """
        self.memory, self._raw[:] = memory, raw
        self._act()
        return self.targets


def action_limits(contract: PolicyContract) -> list[float]:
    """Return the ``limits`` of :func:`act`.

    They are the greatest magnitude of an action, the share of the previous
    targets, whether clipped actions are observed, the greatest change of the
    frequency of the clock, in [1/s], and the step of the phases per period,
    without a change and per [1/s] of it.
    """
    observed, spread = float(contract.observes_clipped), 0.0
    if contract.clock is not None:
        spread = contract.clock.spread
    step, turn = clock_values(contract)[1], 2.0 * pi * contract.period
    clip, share = contract.action_clip, contract.action_filter
    return [clip, share, observed, spread, step, turn]


def clock_values(contract: PolicyContract) -> list[float]:
    """Return the ``clock`` of :func:`observe`, at the start.

    They are the greatest change of a command and the step of the phases per
    period, whether the clock waits while the robot stands, whether it is
    silent then, whether the robot stood, and for how many periods the command
    has been zero and must be zero before the robot stands.
    """
    clock, period = contract.clock, contract.period
    step, waits, silent, settling = 0.0, False, False, 0.0
    if clock is not None:
        step = 2.0 * pi * period / clock.period
        waits, silent = clock.standing != "runs", clock.standing == "silent"
        settling = clock.settling / period
    change = contract.command_rate * period
    return [change, step, waits, silent, 1.0, settling, settling]


class ObservationLayout(NamedTuple):
    """Places of the observed quantities in the input of a network."""

    size: int  # number of all quantities at one instant
    places: dict[str, slice]  # place of each quantity among them, by name
    # quantities of one observation, in order. Shape (n,)
    order: NDArray[np.int_]
    scales: Array  # factor on each. Shape (n,)
    clips: Array  # greatest magnitude of each before scaling. Shape (n,)
    # order of past observations in the input. Shape (history n,)
    flat: NDArray[np.int_]

    @classmethod
    def of(cls, contract: PolicyContract) -> "ObservationLayout":
        """Return the layout of a contract."""
        clock = contract.clock
        phases = 0 if clock is None else len(clock.offsets)
        size, places = _places(len(contract.joints), phases)
        terms = [np.arange(size)[places[x.name]] for x in contract.terms]
        widths = [len(term) for term in terms]
        scales = [
            np.broadcast_to(term.scale, contract.width_of(term))
            for term in contract.terms
        ]
        by_term = contract.history_order == "term"
        return cls(
            size,
            places,
            np.concatenate(terms),
            np.concatenate(scales).astype(np.float64),
            np.repeat([float(term.clip) for term in contract.terms], widths),
            _history_order(widths, contract.history, by_term=by_term),
        )


def _places(joints: int, phases: int) -> tuple[int, dict[str, slice]]:
    """Return the number of all quantities, and the place of each by name."""
    widths = {
        **dict.fromkeys(("base_lin_vel", "base_ang_vel"), 3),
        **dict.fromkeys(("projected_gravity", "command"), 3),
        **dict.fromkeys(("joint_pos", "joint_vel", "actions"), joints),
        **dict.fromkeys(("sin_phase", "cos_phase"), phases),
        "frequency": 1,
    }
    ends = np.cumsum(list(widths.values())).tolist()
    places = {
        name: slice(end - width, end)
        for (name, width), end in zip(widths.items(), ends, strict=True)
    }
    first = places["command"].start
    places["command_lin_vel"] = slice(first, first + 2)
    places["command_ang_vel"] = slice(first + 2, first + 3)
    return ends[-1], places


def _history_order(
    widths: Sequence[int], count: int, *, by_term: bool
) -> NDArray[np.int_]:
    """Return the order of past observations in the input of a network.

    By term, the past of one term precedes that of the next.
    """
    indices = np.arange(count * sum(widths)).reshape(count, -1)
    if not by_term:
        return indices.ravel()
    parts = np.split(indices, np.cumsum(widths)[:-1], axis=1)
    return np.concatenate([part.ravel() for part in parts])
