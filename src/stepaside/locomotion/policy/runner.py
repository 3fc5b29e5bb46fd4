"""Evaluation of a walking policy at its control period."""

from math import pi
from typing import NamedTuple

import numpy as np

from ...core.poses import Array
from .contract import ObservationTerm, PolicyContract
from .network import PolicyNetwork

STANDS_BELOW = 0.01  # magnitude of a command that counts as zero


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
    """

    def __init__(
        self, contract: PolicyContract, network: PolicyNetwork
    ) -> None:
        """Begin standing in the default posture."""
        self.contract, self._network = contract, network
        self._default = np.array(contract.default_posture)
        self._scale = np.array(contract.action_scale)
        self._previous = np.zeros(len(contract.joints))
        self._targets = self._default
        self._command = np.zeros(3)
        self._history: list[list[Array]] = []
        clock = contract.clock
        self._phases = np.array(() if clock is None else clock.offsets)
        self._stands = True
        network.reset()

    def update(self, body: BodyMotion, command: Array) -> Array:
        """Return the joint targets of the next control period.

        Args:
            body: Measured state.
            command: Commanded vx, vy, in [m/s], and turning rate, in
                [rad/s]. Shape (3,).

        Returns:
            Targets, in [rad], in the order of the contract. Shape (joints,).

        Raises:
            PolicyError: If the network returns NaN or infinity.
        """
        contract = self.contract
        change = contract.command_rate * contract.period
        self._command = self._command + np.clip(
            command - self._command, -change, change
        )
        self._advance_clock()
        frame = [self._value(term, body) for term in contract.terms]
        if not self._history:
            self._history = [frame] * contract.history
        self._history = [*self._history[1:], frame]
        raw = self._network.evaluate(self._flat_history())
        clipped = np.clip(raw, -contract.action_clip, contract.action_clip)
        self._previous = clipped if contract.observes_clipped else raw
        share = contract.action_filter
        self._targets = share * self._targets + (1.0 - share) * (
            self._default + self._scale * clipped
        )
        return self._targets

    def _advance_clock(self) -> None:
        """Advance the phases by one control period."""
        clock = self.contract.clock
        if clock is None:
            return
        stands = float(np.abs(self._command).max()) < STANDS_BELOW
        if clock.standing != "runs" and stands:
            self._phases = np.full(len(clock.offsets), pi)
        elif clock.standing != "runs" and self._stands:
            self._phases = np.array(clock.offsets)
        else:
            step = 2.0 * pi * self.contract.period / clock.period
            self._phases = (self._phases + step + pi) % (2.0 * pi) - pi
        self._stands = stands

    def _value(self, term: ObservationTerm, body: BodyMotion) -> Array:
        """Return the values of one term, clipped and scaled."""
        value = np.clip(self._measured(term.name, body), -term.clip, term.clip)
        scaled: Array = value * np.array(term.scale)
        return scaled

    def _measured(self, name: str, body: BodyMotion) -> Array:
        if name in ("sin_phase", "cos_phase"):
            clock = self.contract.clock
            if clock and clock.standing == "silent" and self._stands:
                return np.zeros(self._phases.size)
            wave = np.sin if name == "sin_phase" else np.cos
            found: Array = wave(self._phases)
            return found
        values: dict[str, Array] = {
            "base_lin_vel": body.velocity,
            "base_ang_vel": body.angular_velocity,
            "projected_gravity": body.gravity,
            "command": self._command,
            "command_lin_vel": self._command[:2],
            "command_ang_vel": self._command[2:],
            "joint_pos": body.joint_positions - self._default,
            "joint_vel": body.joint_velocities,
            "actions": self._previous,
        }
        return values[name]

    def _flat_history(self) -> Array:
        """Return the input of the network. Shape (observation width,)."""
        frames = self._history
        if self.contract.history_order == "frame":
            return np.concatenate([value for f in frames for value in f])
        by_term = zip(*frames, strict=True)
        return np.concatenate([value for term in by_term for value in term])
