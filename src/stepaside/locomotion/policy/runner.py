"""Evaluation of a walking policy at its control period."""

from math import pi
from typing import NamedTuple

import numpy as np

from ...core.poses import Array
from .contract import PolicyContract
from .network import Memory, PolicyNetwork

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
        self._previous: Array = np.zeros(len(contract.joints))
        self.targets = self._default
        self._command = np.zeros(3)
        self._history: list[Array] = []
        widths = [contract.width_of(term) for term in contract.terms]
        self._parts = np.cumsum(widths)[:-1]
        self._scales = np.concatenate(
            [
                np.broadcast_to(term.scale, width)
                for term, width in zip(contract.terms, widths, strict=True)
            ]
        )
        clips = np.repeat([term.clip for term in contract.terms], widths)
        self._clips = clips if np.isfinite(clips).any() else None
        clock = contract.clock
        self._phases = np.array(() if clock is None else clock.offsets)
        self._stands = True

    def observe(self, body: BodyMotion, command: Array) -> Array:
        """Return the input of the network at a control period.

        Args:
            body: Measured state.
            command: Commanded vx, vy, in [m/s], and turning rate, in
                [rad/s]. Shape (3,).

        Returns:
            Shape (observation width,).
        """
        contract = self.contract
        change = contract.command_rate * contract.period
        missing = command - self._command
        self._command = self._command + np.minimum(
            np.maximum(missing, -change), change
        )
        self._advance_clock()
        frame = np.concatenate(
            [self._measured(term.name, body) for term in contract.terms]
        )
        if self._clips is not None:
            frame = np.minimum(np.maximum(frame, -self._clips), self._clips)
        frame *= self._scales
        if not self._history:
            self._history = [frame] * contract.history
        self._history = [*self._history[1:], frame]
        return self._flat_history()

    def act(self, raw: Array, memory: Memory) -> Array:
        """Update the targets by the output of the network.

        Args:
            raw: Action. Shape (joints,).
            memory: Recurrent states.

        Returns:
            The targets, in [rad]. Shape (joints,).
        """
        contract, self.memory = self.contract, memory
        limit = contract.action_clip
        clipped = np.minimum(np.maximum(raw, -limit), limit)
        self._previous = clipped if contract.observes_clipped else raw
        share = contract.action_filter
        self.targets = share * self.targets + (1.0 - share) * (
            self._default + self._scale * clipped
        )
        return self.targets

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

    def _measured(self, name: str, body: BodyMotion) -> Array:
        if name in ("sin_phase", "cos_phase"):
            clock = self.contract.clock
            if clock and clock.standing == "silent" and self._stands:
                return np.zeros(self._phases.size)
            wave = np.sin if name == "sin_phase" else np.cos
            found: Array = wave(self._phases)
            return found
        match name:
            case "base_lin_vel":
                return body.velocity
            case "base_ang_vel":
                return body.angular_velocity
            case "projected_gravity":
                return body.gravity
            case "command":
                return self._command
            case "command_lin_vel":
                return self._command[:2]
            case "command_ang_vel":
                return self._command[2:]
            case "joint_pos":
                angles: Array = body.joint_positions - self._default
                return angles
            case "joint_vel":
                return body.joint_velocities
        return self._previous

    def _flat_history(self) -> Array:
        """Return the input of the network. Shape (observation width,)."""
        frames = self._history
        if len(frames) == 1:
            return frames[0]
        if self.contract.history_order == "frame":
            return np.concatenate(frames)
        by_term = zip(
            *(np.split(frame, self._parts) for frame in frames), strict=True
        )
        joined: Array = np.concatenate(
            [value for term in by_term for value in term]
        )
        return joined
