"""Spaces of observations and actions, and intents from actions."""

from collections.abc import Sequence
from math import pi
from typing import Any

import numpy as np
from gymnasium.spaces import Box, Discrete, Space
from numpy.typing import NDArray

from ..core.errors import PlanError
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
        if self.headings:
            return self._rows[self._codes(actions)]
        try:
            values = np.asarray(actions, dtype=np.float64)
        except (TypeError, ValueError):
            values = np.zeros(0)
        if values.ndim != 2 or values.shape[1] != 2:
            raise PlanError(
                "an action must be a heading [rad] and a speed factor [1], "
                f"shape (2,), got shape {_shape_of(actions)}"
            )
        if not np.isfinite(values.sum()):  # or some are large: look again
            bad = values[~np.isfinite(values).all(axis=1)]
            if len(bad):
                got = bad[0].tolist()
                raise PlanError(f"an action must be finite, got {got}")
        rows = np.empty_like(values)
        np.clip(values[:, 0], -pi, pi, out=rows[:, 0])
        np.clip(values[:, 1], 0.0, 1.0, out=rows[:, 1])
        return rows

    def _codes(self, actions: Any) -> NDArray[np.int64]:
        codes = np.asarray(actions)
        count = len(self.headings)
        if codes.ndim == 2 and codes.shape[1] == 1:
            codes = codes[:, 0]
        if codes.ndim != 1 or not np.issubdtype(codes.dtype, np.integer):
            raise PlanError(
                f"an action must be an integer below {count}, got "
                f"{actions[0]!r:.40}"
            )
        if codes.size and not 0 <= codes.min() <= codes.max() < count:
            bad = codes[(codes < 0) | (codes >= count)][0]
            raise PlanError(
                f"an action must be an integer below {count}, got {bad}"
            )
        return codes.astype(np.int64)


def _shape_of(actions: Any) -> tuple[int, ...]:
    """Return the shape of one action."""
    try:
        shape: tuple[int, ...] = np.shape(actions)[1:]
    except ValueError:  # ragged
        return ()
    return shape
