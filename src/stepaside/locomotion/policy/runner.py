"""Evaluation of a walking policy, and of its network by ONNX Runtime."""

import re
from collections.abc import Mapping, Sequence
from functools import cached_property
from math import cos, pi, sin
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.compilation import bound, compiled
from ...core.errors import PolicyError
from ...core.onnx_sessions import check_readable, open_network
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
        """Size of the only axis with more than one value, else the last."""
        known = [size for size in self.shape if size not in (None, 1)]
        return known[0] if len(known) == 1 else self.shape[-1]

    def __str__(self) -> str:
        """Return name and shape, as in a message."""
        sizes = ("any" if size is None else str(size) for size in self.shape)
        return f"{self.name} [{', '.join(sizes)}]"

    def zeros(self) -> NDArray[np.floating[Any]]:
        """Return zeros for one walker."""
        return np.zeros([size or 1 for size in self.shape], KINDS[self.kind])


class PolicyNetwork:
    """Network that maps observations to actions.

    Further inputs are recurrent states, zero at the start: each is fed back
    from the output of its name and shape.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            check_readable(path)
        except PolicyError as error:
            raise PolicyError(f"legs: {error}") from error
        try:
            self._session = open_network(path)
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
        self._check(once[0].ravel())
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
        """Return action, which the next one changes, and recurrent states.

        ``observation``: Shape (width of the input,).
        """
        observed, action, states, after, binding = self.arrays
        if observation is not observed:
            observed[:] = observation
        for state, before in zip(states, memory, strict=True):
            state[:] = before
        self._session.run_with_iobinding(binding)
        # most often it is
        if not float(action.dot(action)) < 0.5 * LARGEST_ACTION**2:
            self._check(action)
        return action, tuple([state.copy() for state in after])

    def _check(self, action: Array) -> None:
        """Refuse an action that is NaN, infinite or huge."""
        usable = np.abs(action) <= LARGEST_ACTION  # NaN is not
        if not usable.all():
            at = int(np.argmin(usable))
            raise PolicyError(
                f"legs: output {at} of {self.path} must be finite and at most "
                f"{LARGEST_ACTION:g}, got {action[at]:g}"
            )

    @cached_property
    def arrays(self) -> tuple[Any, ...]:
        """Arrays bound to the session; to pass them takes a third longer.

        Observation, action, states before and after, and the binding.
        """
        # Networks may leave sizes of outputs open: a run shows them.
        feed = {port.name: port.zeros() for port in self._inputs}
        found = self._session.run(self._outputs, feed)
        binding = self._session.io_binding()
        for bind, names, arrays in (
            (binding.bind_input, feed, feed.values()),
            (binding.bind_output, self._outputs, found),
        ):
            for name, array in zip(names, arrays, strict=True):
                place = array.__array_interface__["data"][0]
                bind(name, "cpu", 0, array.dtype.type, array.shape, place)
        given, (action, *after) = list(feed.values()), found
        flat = given[0].reshape(-1), action.reshape(-1)
        return *flat, given[1:], after, binding


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
    rest.sort(key=lambda port: "obs" not in port.name.lower())
    free.sort(key=lambda port: "action" not in port.name.lower())
    if not (rest and free):
        raise PolicyError(
            f"legs: {path} must have an observation and an action beside its "
            "recurrent states"
        )
    action = free[0]
    alike = [str(out) for out in free if out.shape == action.shape]
    if len(alike) > 1 and "action" not in action.name.lower():
        raise PolicyError(
            f"legs: one output of {path} must be named action, got "
            + ", ".join(alike)
        )
    pairs = [(rest[0], action)]
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
        """Begin standing in the default posture, at joints of the motion."""
        self.contract, self.memory = contract, network.initial_memory()
        places, terms = contract.places(), contract.terms
        every = np.arange(places["frequency"].stop)
        parts = [every[places[term.name]] for term in terms]
        widths = [len(part) for part in parts]
        scales = [
            np.broadcast_to(term.scale, width)
            for term, width in zip(terms, widths, strict=True)
        ]
        shape = contract.history, sum(widths)
        past: NDArray[np.int_] = np.arange(np.prod(shape)).reshape(shape)
        if contract.history_order == "term":
            by_term = np.split(past, np.cumsum(widths)[:-1], axis=1)
            past = np.concatenate([part.ravel() for part in by_term])
        self._frame: Array
        self._frame, self._raw = (  # compiled loops take no half floats
            port.astype(float) if port.dtype == np.float16 else port
            for port in network.arrays[:2]
        )
        if contract.history > 1:
            self._frame = np.zeros(sum(widths))
        self._flat, self._history = past.ravel(), np.zeros(0)
        posture = np.array(contract.default_posture, dtype=np.float64)
        self.targets = posture.copy()  # [rad] (joints,)
        values = every * 0.0
        clock, period = contract.clock, contract.period
        step = spread = settling = 0.0
        waits = silent = False
        offsets = np.array(() if clock is None else clock.offsets, dtype=float)
        if clock is not None:
            step, spread = 2.0 * pi * period / clock.period, clock.spread
            waits = clock.standing != "runs"
            silent = clock.standing == "silent"
            settling = clock.settling / period
        # Greatest change of a command, step of the phases, whether the clock
        # waits or is silent while the robot stands, whether it stood, and for
        # how many periods the command has been and must be zero until then.
        change = contract.command_rate * period
        gait = [change, step, waits, silent, 1.0, settling, settling]
        state = np.array(gait, dtype=np.float64)
        # Greatest action, share of the previous targets, whether clipped
        # actions are observed, greatest change of the frequency [1/s], and
        # step of the phases without and per change.
        limits = [contract.action_clip, contract.action_filter]
        limits += [float(contract.observes_clipped), spread, step]
        limits += [2.0 * pi * period]
        self.loop = bound(
            *(observe, *motion, np.array(joints, dtype=np.int64), posture),
            *(values, offsets.copy(), offsets, state, np.concatenate(parts)),
            np.repeat([float(term.clip) for term in terms], widths),
            *(np.concatenate(scales).astype(np.float64), self._frame),
        )
        self._act = bound(
            *(act, self._raw, posture),
            *(np.array(contract.action_scale, dtype=float), np.array(limits)),
            *(values[places["actions"]], self.targets),
            *(values[places["frequency"]], state),
        )

    def observation(self) -> Array:
        """Return the input of the network; it changes with the next one.

        Shape (observation width,).
        """
        frame, count = self._frame, self.contract.history
        if count == 1:
            return frame
        if not self._history.size:
            self._history = np.tile(frame, (count, 1))
        self._history[:-1] = self._history[1:]
        self._history[-1] = frame
        found: Array = self._history.ravel().take(self._flat)
        return found

    def act(self, raw: Array, memory: Memory) -> Array:
        """Return the targets, in [rad], by the output of the network."""
        self.memory = memory
        if raw is not self._raw:
            self._raw[:] = raw
        self._act()
        return self.targets
