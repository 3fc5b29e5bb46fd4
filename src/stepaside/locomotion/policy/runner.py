"""Evaluation of a walking policy at its control period."""

from collections.abc import Sequence
from math import inf, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.machine_code import bound_loop
from ...core.poses import Array
from .contract import PhaseClock, PolicyContract
from .network import Memory, PolicyNetwork

STANDS_BELOW = 0.01  # magnitude of a command that counts as zero
ADVANCE = f"""\
def advance(given, command, phases, offsets, sines, cosines, clock):
    still = 1.0
    for i in range(3):
        change = given[i] - command[i]
        command[i] += min(max(change, -clock[0]), clock[0])
        still = still if abs(command[i]) < {STANDS_BELOW} else 0.0
    clock[5] = still * (clock[5] + 1.0)
    stands = 1.0 if clock[5] > clock[6] else 0.0
    seen = 1.0 - clock[3] * stands
    for k in range(phases.shape[0]):
        phase = phases[k] + clock[1] + {pi}
        phase = phase if phase < {2.0 * pi} else phase - {2.0 * pi}
        phase -= {pi}
        if clock[2] > 0.0 and stands > 0.0:
            phase = {pi}
        elif clock[2] > 0.0 and clock[4] > 0.0:
            phase = offsets[k]
        phases[k] = phase
        sines[k] = seen * sin(phase)
        cosines[k] = seen * cos(phase)
    clock[4] = stands
"""


class BodyMotion(NamedTuple):
    """Measured state of a body, as policies observe it.

    Attributes:
        joint_positions: Angles of the joints of the policy, in [rad].
        joint_velocities: Their velocities, in [rad/s].
        angular_velocity: Of the torso in its frame, in [rad/s]. Shape (3,).
        gravity: Unit vector of gravity in the torso frame. Shape (3,).
        velocity: Of the torso in its frame, in [m/s]. Shape (3,).
    """

    joint_positions: Array
    joint_velocities: Array
    angular_velocity: Array
    gravity: Array
    velocity: Array


class PolicyRunner:
    """Policy with its clock, history and previous action.

    Attributes:
        contract: Contract of the network.
        memory: Recurrent states of the network.
        targets: Joint targets, in [rad], in the order of the contract. Shape
            (joints,).
    """

    def __init__(
        self, contract: PolicyContract, network: PolicyNetwork
    ) -> None:
        """Begin standing in the default posture."""
        self.contract, self.memory = contract, network.initial_memory()
        self._default = np.array(contract.default_posture)
        self._scale = np.array(contract.action_scale)
        self.targets = self._default.copy()
        layout = ObservationLayout.of(contract)
        self._values = np.zeros(layout.size)
        self._parts = {
            name: self._values[place] for name, place in layout.places.items()
        }
        self._order, self._scales = layout.order, layout.scales
        finite = np.isfinite(layout.clips).any()
        self._clips = layout.clips if finite else None
        self._history: Array | None = None
        self._flat = layout.flat
        clock = contract.clock or PhaseClock(inf, ())
        offsets = np.array(clock.offsets, dtype=np.float64)
        self._command = np.zeros(3)
        self._advance = bound_loop(
            *("advance", ADVANCE, "1111111"),
            *(self._command, self._parts["command"]),
            *(offsets.copy(), offsets),
            *(self._parts["sin_phase"], self._parts["cos_phase"]),
            np.array(clock_values(contract)),
        )

    def observe(
        self, body: BodyMotion, command: Sequence[float] | Array
    ) -> Array:
        """Return the input of the network at a control period.

        Args:
            body: Measured state.
            command: Commanded vx, vy, in [m/s], and turning rate, in
                [rad/s]. Shape (3,).

        Returns:
            Shape (observation width,).
        """
        contract, parts = self.contract, self._parts
        self._command[:] = command
        self._advance()
        parts["base_lin_vel"][:] = body.velocity
        parts["base_ang_vel"][:] = body.angular_velocity
        parts["projected_gravity"][:] = body.gravity
        np.subtract(
            body.joint_positions, self._default, out=parts["joint_pos"]
        )
        parts["joint_vel"][:] = body.joint_velocities
        frame: Array = self._values.take(self._order)
        if self._clips is not None:
            frame = np.minimum(np.maximum(frame, -self._clips), self._clips)
        frame *= self._scales
        if contract.history == 1:
            return frame
        if self._history is None:
            self._history = np.tile(frame, (contract.history, 1))
        self._history[:-1] = self._history[1:]
        self._history[-1] = frame
        found: Array = self._history.ravel().take(self._flat)
        return found

    def act(self, raw: Array, memory: Memory) -> Array:
        """Update the targets by the output of the network.

        Args:
            raw: Action. Shape (joints,).
            memory: Recurrent states.

        Returns:
            The targets, in [rad]. Shape (joints,).
        """
        contract, self.memory = self.contract, memory
        limit, share = contract.action_clip, contract.action_filter
        clipped = raw
        if limit < inf:
            clipped = np.minimum(np.maximum(raw, -limit), limit)
        self._parts["actions"][:] = (
            clipped if contract.observes_clipped else raw
        )
        targets = self._default + self._scale * clipped
        if share > 0.0:
            targets = share * self.targets + (1.0 - share) * targets
        self.targets = targets
        return targets


def clock_values(contract: PolicyContract) -> list[float]:
    """Return the last argument of :data:`ADVANCE`, at the start.

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
    """Places of the observed quantities in the input of a network.

    Attributes:
        size: Number of all quantities at one instant.
        places: Place of each quantity among them, by name.
        order: Quantities of one observation, in order. Shape (n,).
        scales: Factor on each. Shape (n,).
        clips: Greatest magnitude of each before scaling. Shape (n,).
        flat: Order of past observations in the input. Shape (history n,).
    """

    size: int
    places: dict[str, slice]
    order: NDArray[np.int_]
    scales: Array
    clips: Array
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
            np.concatenate(scales),
            np.repeat([term.clip for term in contract.terms], widths),
            _history_order(widths, contract.history, by_term=by_term),
        )


def _places(joints: int, phases: int) -> tuple[int, dict[str, slice]]:
    """Return the number of all quantities, and the place of each by name.

    Args:
        joints: Number of joints.
        phases: Number of phases of the clock.
    """
    widths = {
        **dict.fromkeys(("base_lin_vel", "base_ang_vel"), 3),
        **dict.fromkeys(("projected_gravity", "command"), 3),
        **dict.fromkeys(("joint_pos", "joint_vel", "actions"), joints),
        **dict.fromkeys(("sin_phase", "cos_phase"), phases),
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

    Args:
        widths: Widths of the terms of an observation.
        count: Number of observations.
        by_term: Whether the past of one term precedes that of the next.

    Returns:
        Indices into the observations, one after the other. Shape
        (observation width,).
    """
    indices = np.arange(count * sum(widths)).reshape(count, -1)
    if not by_term:
        return indices.ravel()
    parts = np.split(indices, np.cumsum(widths)[:-1], axis=1)
    return np.concatenate([part.ravel() for part in parts])
