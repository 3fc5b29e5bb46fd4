"""Test the learner: gradients, and that it learns."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from train_evader import (
    OptimisationSettings,
    Perceptron,
    PolicyOptimiser,
    log_softmax,
    policy_slope,
)

from stepaside.envs import VectorDuel
from stepaside.games import duel
from stepaside.planning import Direction
from stepaside.strategies.learned import observe
from stepaside.strategies.own_strategy import trial_knowledge

RANDOM = np.random.default_rng(8)


def slope_of(
    loss: Callable[[], float], values: np.ndarray, step: float
) -> np.ndarray:
    """Central differences of a loss by each value."""
    found = np.zeros(values.shape)
    for at in np.ndindex(values.shape):
        here = values[at]
        values[at] = here + step
        above = loss()
        values[at] = here - step
        found[at] = (above - loss()) / (2.0 * step)
        values[at] = here
    return found


def test_back_propagation_gives_the_gradient() -> None:
    network = Perceptron((3, 5, 4, 2), RANDOM, 1.0)
    # Biases away from zero, where a unit that sees only zeros has a kink.
    layers: Any = [x + RANDOM.normal(size=x.shape) for x in network.layers]
    network.layers[:] = layers
    inputs, goal = RANDOM.normal(size=(7, 3)), RANDOM.normal(size=(7, 2))

    def loss() -> float:
        return float(0.5 * ((network.forward(inputs)[-1] - goal) ** 2).sum())  # type: ignore[arg-type]

    outputs: Any = network.forward(inputs)  # type: ignore[arg-type]
    found = network.gradients(outputs, outputs[-1] - goal)
    for values, gradient in zip(network.layers, found, strict=True):
        expected = slope_of(loss, values, 1e-6)
        np.testing.assert_allclose(gradient, expected, atol=1e-7)


@pytest.mark.parametrize("weight", [0.0, 0.3])
def test_the_slope_of_the_policy_is_that_of_the_clipped_loss(
    weight: float,
) -> None:
    logits = RANDOM.normal(size=(6, 4))
    actions = RANDOM.integers(4, size=6)
    rows = np.arange(6)
    gain = RANDOM.normal(size=6)
    # Ratios within the limits, and beyond them on both sides.
    before = log_softmax(logits)[rows, actions]  # type: ignore[arg-type]
    before = before + np.array([0.0, 0.1, -0.1, 0.5, -0.5, 0.5])

    def loss() -> float:
        chances = log_softmax(logits)  # type: ignore[arg-type]
        ratio = np.exp(chances[rows, actions] - before)
        limited = np.clip(ratio, 0.8, 1.2)
        entropy = -(np.exp(chances) * chances).sum(axis=1)
        return float(
            -np.minimum(ratio * gain, limited * gain).mean()
            - weight * entropy.mean()
        )

    found, entropy = policy_slope(
        logits,  # type: ignore[arg-type]
        (actions, before, gain),  # type: ignore[arg-type]
        clip=0.2,
        weight=weight,
    )
    expected = slope_of(loss, logits, 1e-6)
    np.testing.assert_allclose(found, expected, atol=1e-6)
    assert 0.0 < entropy < np.log(4)


def test_descent_finds_the_least_squares() -> None:
    network = Perceptron((2, 16, 1), RANDOM, 1.0)
    inputs = RANDOM.normal(size=(256, 2)).astype(np.float32)
    goal = inputs[:, :1] * 0.5 + np.abs(inputs[:, 1:])
    for _ in range(300):
        outputs: Any = network.forward(inputs)
        slope = (outputs[-1] - goal) / np.float32(256)
        network.descend(network.gradients(outputs, slope), 1e-2)
    assert float(((outputs[-1] - goal) ** 2).mean()) < 0.01


def games(**changes: object) -> VectorDuel:
    settings = {
        "level": "steps",
        "any_heading": True,
        "opponent": "stand",
        "duration": 50 * 0.547,
        "arenas": 64,
        "duel": duel(capture=0.1),
        "action": "discrete",
        "full_state": True,
    }
    return VectorDuel(64, role="pursuer", **settings | changes)  # type: ignore[arg-type]


@pytest.mark.slow
def test_a_pursuer_learns_to_approach_a_standing_evader() -> None:
    settings = OptimisationSettings(
        updates=12, steps=50, batch=1024, hidden=(32,), rate=3e-3
    )
    seen: list[float] = []
    learner = PolicyOptimiser(games(), settings, seed=1)
    strategy = learner.train(lambda progress: seen.append(progress.closest_m))
    assert len(seen) == 12
    assert seen[-1] < seen[0] - 0.1
    assert strategy.direction is Direction.FORWARD
    observation = observe(next(trial_knowledge()), strategy.contract.terms)
    assert strategy.intents(observation[None]).shape == (1, 2)
    # The same seed gives the same policy.
    again = PolicyOptimiser(games(), settings, seed=1).train()
    assert again.network == strategy.network
