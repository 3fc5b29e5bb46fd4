"""Spaces of observations and actions, and intents from actions."""

from collections.abc import Sequence
from math import pi
from typing import Any

import numpy as np
from gymnasium.spaces import Box, Discrete, Space

from ..core.errors import PlanError, shown
from ..core.poses import Array
from ..strategies.knowledge import STAND, Intent
from .environment_settings import ALL_TERMS, EnvironmentSettings

FLOAT = np.float32


def observation_space(terms: Sequence[str]) -> Box:
    """Return the space of observations with some terms, in order."""
    ranges = [ALL_TERMS[name] for name in terms]
    low = [t.low for t in ranges for _ in range(t.width)]
    high = [t.high for t in ranges for _ in range(t.width)]
    return Box(np.array(low, FLOAT), np.array(high, FLOAT), dtype=FLOAT)


class IntentActions:
    """Actions of one environment, and the intents that they mean.

    A continuous action is a heading, in [-pi, pi] [rad], in the frame of the
    player, and a speed factor, in [0, 1]; 0 stands. Values beyond are
    limited. A discrete action is one of evenly spaced headings at full
    speed, or, the last, to stand.

    Attributes:
        space: Space of actions.
        headings: Heading of each discrete action, in [rad]; None to stand.
    """

    def __init__(self, settings: EnvironmentSettings) -> None:
        """Build the space of actions.

        Args:
            settings: Settings of the environment.
        """
        self.headings = settings.action_headings
        self.space: Space[Any]
        if self.headings:
            self.space = Discrete(len(self.headings))
        else:
            low = np.array([-pi, 0.0], FLOAT)
            self.space = Box(low, np.array([pi, 1.0], FLOAT), dtype=FLOAT)
        self._rows = np.array(
            [(h or 0.0, h is not None) for h in self.headings], np.float64
        )

    def intent(self, action: Any) -> Intent:
        """Return the intent that an action means.

        Raises:
            PlanError: If the action has another shape, or is not finite.
        """
        heading, speed = self.rows([action])[0].tolist()
        return Intent(heading, speed) if speed > 0.0 else STAND

    def rows(self, actions: Any) -> Array:
        """Return headings [rad] and speed factors of many actions.

        Args:
            actions: Shape (n,) if discrete, else (n, 2).

        Returns:
            Shape (n, 2).

        Raises:
            PlanError: If the actions have another shape, or are not finite.
        """
        values = np.array(actions)
        if self.headings:
            codes, count = values.reshape(len(values), -1), len(self.headings)
            if codes.shape[1] != 1 or codes.dtype.kind not in "iu":
                raise PlanError(
                    f"an action must be an integer below {count}, got "
                    f"{shown(actions[0])}"
                )
            if ((codes < 0) | (codes >= count)).any():
                raise PlanError(
                    f"an action must be an integer in [0, {count - 1}], got "
                    f"{codes.min() if codes.min() < 0 else codes.max()}"
                )
            found: Array = self._rows[codes[:, 0]]
            return found
        if values.ndim != 2 or values.shape[1] != 2:
            raise PlanError(
                "an action must be a heading [rad] and a speed factor [1], "
                f"shape (2,), got shape {values.shape[1:]}"
            )
        rows = np.clip(values.astype(np.float64), (-pi, 0.0), (pi, 1.0))
        if np.isnan(rows).any():
            got = values[np.isnan(rows).any(axis=1)][0].tolist()
            raise PlanError(f"an action must be finite, got {got}")
        return rows
