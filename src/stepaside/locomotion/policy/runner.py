"""Evaluation of a walking policy, and of its network by ONNX Runtime."""

import re
from collections.abc import Mapping, Sequence
from math import cos, pi, sin
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.compilation import bound, compiled
from ...core.errors import PolicyError
from ...core.onnx_sessions import check_readable, open_session
from ...core.poses import Array
from .contract import PolicyContract

Memory = tuple[NDArray[np.floating[Any]], ...]  # states of one walker
KINDS: Mapping[str, type[np.floating[Any]]] = {
    "tensor(float16)": np.float16,
    "tensor(float)": np.float32,
    "tensor(double)": np.float64,
}
LARGEST_ACTION = 1e4  # beyond, a simulation becomes unstable
DIRECTIONS = {"in", "out", "input", "output", "prev", "next", "new", "old"}


class TensorShape(NamedTuple):
    """Input or output of a network."""

    name: str
    # its shape; None for a size that the network leaves open
    shape: tuple[int | None, ...]
    # type of its numbers, as ONNX Runtime writes it
    kind: str = "tensor(float)"

    @property
    def width(self) -> int | None:
        """Size of the last axis."""
        return self.shape[-1] if self.shape else None

    def __str__(self) -> str:
        """Return name and shape, as in a message."""
        sizes = ("any" if size is None else str(size) for size in self.shape)
        return f"{self.name} [{', '.join(sizes)}]"

    def zeros(self) -> NDArray[np.floating[Any]]:
        """Return zeros for one walker."""
        return np.zeros([size or 1 for size in self.shape], KINDS[self.kind])


class PolicyNetwork:
    """Network that maps observations to actions.

    Inputs beside the observation are recurrent states: each is fed back from
    the output of its name and shape, see :func:`_stem`, and is zero at the
    start.
    """

    def __init__(self, path: Path) -> None:
        """Load a network."""
        self.path = path
        try:
            check_readable(path)
        except PolicyError as error:
            raise PolicyError(f"legs: {error}") from error
        try:
            self._session = open_session(str(path))
        except PolicyError as error:
            raise PolicyError(
                f"legs: {path} is not an ONNX network: {error}"
            ) from error
        ports = self._session.get_inputs(), self._session.get_outputs()
        self.metadata: Mapping[str, str] = dict(
            self._session.get_modelmeta().custom_metadata_map
        )
        pairs = _pair_ports(path, *([_shape_of(x) for x in p] for p in ports))
        (self.observation, self.action), *self.states = pairs
        self._outputs = [out.name for _, out in pairs]
        self._inputs = [given for given, _ in pairs]
        for port in (port for pair in pairs for port in pair):
            if port.kind not in KINDS:
                raise PolicyError(
                    f"legs: {port.name} of {path} must be of "
                    f"{', '.join(KINDS)}, got {port.kind}"
                )
            if not 1 <= len(port.shape) <= 3:
                raise PolicyError(
                    f"legs: {port} of {path} must have one to three axes"
                )
        self.draws = self._try()
        self._bind()

    def _try(self) -> bool:
        """Evaluate once, and again to see whether outputs repeat."""
        draw = np.random.default_rng(0).standard_normal
        feed = {}
        for port in self._inputs:
            zeros = port.zeros()
            feed[port.name] = draw(zeros.shape).astype(zeros.dtype)
        try:
            once, again = (
                self._session.run(self._outputs, feed) for _ in range(2)
            )
        except Exception as error:  # no common base in ONNX Runtime
            raise PolicyError(
                f"legs: {self.path} cannot run for one walker: "
                + " ".join(str(error).split())
            ) from error
        width = once[0].size
        self.action = self.action._replace(shape=(1, width))
        return any(
            not np.array_equal(*both, equal_nan=True)
            for both in zip(once, again, strict=True)
        )

    def initial_memory(self) -> Memory:
        """Return recurrent states of zero, for one walker."""
        return tuple(given.zeros() for given, _ in self.states)

    def evaluate(
        self, observation: Array, memory: Memory
    ) -> tuple[Array, Memory]:
        """Return action and new recurrent states.

        ``observation``: Shape (width of the input,).
        """
        first, *states = self._given
        first.reshape(-1)[:] = observation
        for state, before in zip(states, memory, strict=True):
            state[:] = before
        self._session.run_with_iobinding(self._binding)
        action: Array = self._found[0].astype(np.float64).ravel()
        if not action @ action < 0.5 * LARGEST_ACTION**2:  # most often it is
            self._check(action)
        return action, tuple(state.copy() for state in self._found[1:])

    def _check(self, action: Array) -> None:
        """Refuse an action that is NaN, infinite or huge."""
        usable = np.abs(action) <= LARGEST_ACTION  # NaN is not
        if not usable.all():
            at = int(np.argmin(usable))
            raise PolicyError(
                f"legs: output {at} of {self.path} must be finite and at most "
                f"{LARGEST_ACTION:g}, got {action[at]:g}"
            )

    def _bind(self) -> None:
        """Bind arrays to the session; to pass them takes a third longer."""
        # Networks may leave sizes of outputs open: a run shows them.
        feed = {port.name: port.zeros() for port in self._inputs}
        self._given = list(feed.values())
        self._found = self._session.run(self._outputs, feed)
        self._binding = binding = self._session.io_binding()
        names = list(feed), self._outputs
        binds = binding.bind_input, binding.bind_output
        arrays = self._given, self._found
        for bind, keys, own in zip(binds, names, arrays, strict=True):
            for key, array in zip(keys, own, strict=True):
                place = array.__array_interface__["data"][0]
                bind(key, "cpu", 0, array.dtype.type, array.shape, place)


def _shape_of(node: Any) -> TensorShape:
    sizes = (s if isinstance(s, int) else None for s in node.shape)
    return TensorShape(node.name, tuple(sizes), node.type)


def _stem(port: TensorShape) -> str:
    """Return what the names of a state's input and output share.

    They are like "h_in" and "h_out", or "h0" and "hn".
    """
    words = re.split(r"[^a-z0-9]+", port.name.lower())
    return "_".join(w for w in words if w not in DIRECTIONS).rstrip("0n")


def _fit(one: TensorShape, other: TensorShape) -> bool:
    """Return whether two shapes may be the same."""
    return len(one.shape) == len(other.shape) and all(
        a == b or None in (a, b)
        for a, b in zip(one.shape, other.shape, strict=True)
    )


def _pair_ports(
    path: Path, inputs: list[TensorShape], outputs: list[TensorShape]
) -> list[tuple[TensorShape, TensorShape]]:
    """Pair the observation with the action, then states with their outputs.

    A state whose name tells nothing has the only output of its shape.
    """
    named = [
        (given, out)
        for given in inputs
        for out in outputs
        if _stem(given) == _stem(out) != "" and _fit(given, out)
    ]
    rest = [x for x in inputs if x not in [given for given, _ in named]]
    free = [x for x in outputs if x not in [out for _, out in named]]
    if not (rest and free):
        raise PolicyError(
            f"legs: {path} must have an observation and an action beside its "
            "recurrent states"
        )
    pairs = [(rest[0], free[0])]
    for given in rest[1:]:
        fits = [out for out in free[1:] if _fit(given, out)]
        if len(fits) != 1:
            names = ", ".join(map(str, free[1:])) or "none"
            raise PolicyError(
                f"legs: input {given} of {path} must be fed back from one "
                f"output of its name, like h_in from h_out, or of its shape, "
                f"got {names}"
            )
        pairs.append((given, fits[0]))
    return pairs + named


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
