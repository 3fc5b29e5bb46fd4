# /// script
# dependencies = ["stepaside[learn]"]
# ///
"""Train an evader by PPO on one core, and compare it with the optimum.

Run it alone: ``python examples/train_evader.py`` on an open floor, or
``... discs 200`` in rooms with three discs, with 200 updates. The policy is
evader-open.onnx or evader-discs.onnx, for ``stepaside duel --strategy``, the
training curve training-open.png or training-discs.png.

The learner is proximal policy optimisation in numpy: discrete actions, one
actor and one critic (Schulman et al. 2017, with generalised advantage
estimation). The critic sees the full state, the actor what a robot senses.
"""

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import process_time
from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

from stepaside.arena import RoomRecipe
from stepaside.envs import VectorDuel
from stepaside.games import duel
from stepaside.strategies.learned import LearnedStrategy, dense_network
from stepaside.studies import load_study, run_study

ROOMS = {"open": None, "discs": RoomRecipe(discs=3)}
FLOORS = {"open": "open*,any*", "discs": "*discs"}


Values = NDArray[np.float32]
Layers = list[Values]  # weights and biases in turn
BETAS, EPSILON = (0.9, 0.999), 1e-8  # of Adam
STEEPEST = 0.5  # norm to which gradients are limited


@dataclass(frozen=True, slots=True)
class OptimisationSettings:
    """Settings of a training run.

    Attributes:
        updates: Number of updates.
        steps: Decisions of every game between two updates.
        epochs: Passes over these decisions.
        batch: Decisions of a minibatch.
        rate: Learning rate at first; it falls linearly to a tenth.
        clip: Greatest change of a probability ratio.
        entropy: Weight of the entropy at first; it falls linearly to zero.
        trace: Decay of the advantage estimate, lambda.
        hidden: Units of each hidden layer.
    """

    updates: int = 150
    steps: int = 75
    epochs: int = 4
    batch: int = 4096
    rate: float = 1e-3
    clip: float = 0.2
    entropy: float = 0.01
    trace: float = 0.95
    hidden: tuple[int, ...] = (64, 64)


class TrainingProgress(NamedTuple):
    """Progress after an update.

    Attributes:
        update: Number of the update, from 1.
        decisions: Decisions so far, of all games.
        closest_m: Mean closest approach of the episodes that ended, in [m];
            NaN if none did.
        entropy: Mean entropy of the policy, in [nat].
    """

    update: int
    decisions: int
    closest_m: float
    entropy: float


class Perceptron:
    """Dense network with rectified units, and its optimiser Adam.

    Attributes:
        layers: Weights, shape (inputs, outputs), and biases of each layer in
            turn.
    """

    def __init__(
        self, sizes: Sequence[int], random: np.random.Generator, last: float
    ) -> None:
        """Draw orthogonal weights.

        Args:
            sizes: Width of the input, of hidden layers and of the output.
            random: Generator.
            last: Scale of the weights of the last layer.
        """
        self.layers: Layers = []
        for n, (inputs, outputs) in enumerate(
            zip(sizes, sizes[1:], strict=False)
        ):
            scale = last if n == len(sizes) - 2 else 2.0**0.5
            tall = random.normal(size=(max(inputs, outputs),) * 2)
            basis = np.linalg.qr(tall)[0][:inputs, :outputs]
            self.layers.append((scale * basis).astype(np.float32))
            self.layers.append(np.zeros(outputs, np.float32))
        self._moments = [np.zeros_like(x) for x in self.layers]
        self._squares = [np.zeros_like(x) for x in self.layers]
        self._count = 0

    def forward(self, inputs: Values) -> list[Values]:
        """Return the input and the output of each layer, in order."""
        outputs = [inputs]
        for n in range(0, len(self.layers), 2):
            made = outputs[-1] @ self.layers[n] + self.layers[n + 1]
            if n + 2 < len(self.layers):
                np.maximum(made, 0.0, out=made)
            outputs.append(made)
        return outputs

    def gradients(self, outputs: list[Values], slope: Values) -> Layers:
        """Return the gradient of a loss by back-propagation.

        Args:
            outputs: Result of :meth:`forward`.
            slope: Derivative of the loss by the last output.
        """
        found: Layers = []
        for n in range(len(self.layers) - 2, -1, -2):
            below = outputs[n // 2]
            found += [slope.sum(axis=0), below.T @ slope]
            if n:
                slope = (slope @ self.layers[n].T) * (below > 0.0)
        return found[::-1]

    def descend(self, gradients: Layers, rate: float) -> None:
        """Take one step of Adam."""
        norm = float(np.sqrt(sum(float((g * g).sum()) for g in gradients)))
        scale = np.float32(min(1.0, STEEPEST / max(norm, 1e-12)))
        self._count += 1
        first, second = (1.0 - b**self._count for b in BETAS)
        step = np.float32(rate * second**0.5 / first)
        for x, g, m, s in zip(
            self.layers, gradients, self._moments, self._squares, strict=True
        ):
            g = scale * g
            m += np.float32(1.0 - BETAS[0]) * (g - m)
            s += np.float32(1.0 - BETAS[1]) * (g * g - s)
            x -= step * m / (np.sqrt(s) + np.float32(EPSILON))


class Rollout(NamedTuple):
    """Decisions of all games between two updates.

    Attributes:
        observations: Shape (steps + 1, games, width).
        actions: Shape (steps, games).
        likelihoods: Log-probabilities of the actions, of the same shape.
        rewards: Of the same shape.
        ends: 1 where an episode ended with the decision, else 0.
    """

    observations: Values
    actions: NDArray[np.int64]
    likelihoods: Values
    rewards: Values
    ends: Values


class PolicyOptimiser:
    """Trains one player of a vector environment.

    Attributes:
        actor: Network from what is sensed to the logits of the actions.
        critic: Network from the full state to the return.
    """

    def __init__(
        self, games: VectorDuel, settings: OptimisationSettings, seed: int
    ) -> None:
        """Draw the networks and begin the games.

        Args:
            games: The games, with discrete actions and the full state.
            settings: Settings of the training.
            seed: Seed of everything drawn.

        Raises:
            ValueError: If the environment has continuous actions, or
                no full state.
        """
        check_learnable(games)
        self._games, self._settings = games, settings
        self._contract = games.settings.contract(games.role)
        self._sensed = self._contract.observation_width
        self._random = np.random.default_rng(seed)
        whole = games.single_observation_space.shape
        assert whole is not None
        hidden, actions = settings.hidden, self._contract.action_width
        self.actor = Perceptron(
            (self._sensed, *hidden, actions), self._random, 0.01
        )
        self.critic = Perceptron((whole[0], *hidden, 1), self._random, 1.0)
        self._observations = games.reset(seed=seed)[0]
        self._closest: list[float] = []
        self._decisions = 0

    def change_games(self, games: VectorDuel, seed: int) -> None:
        """Go on in other games, such as against another opponent.

        Args:
            games: The games, with the same role and observations.
            seed: Seed of the games.

        Raises:
            ValueError: If role, observations or actions differ.
        """
        check_learnable(games)
        if games.settings.contract(games.role) != self._contract:
            raise ValueError(
                "games must have the same role, observations and actions"
            )
        self._games = games
        self._observations = games.reset(seed=seed)[0]

    def strategy(self) -> LearnedStrategy:
        """Return the present policy: the most probable action."""
        layers = self.actor.layers
        pairs = [
            (layers[n].copy(), layers[n + 1].copy())
            for n in range(0, len(layers), 2)
        ]
        return LearnedStrategy(dense_network(pairs), self._contract)

    def train(
        self, report: Callable[[TrainingProgress], None] | None = None
    ) -> LearnedStrategy:
        """Run all updates and return the policy.

        Args:
            report: Called after each update.
        """
        count = self._settings.updates
        for n in range(count):
            progress = self.update(n, 1.0 - n / count)
            if report is not None:
                report(progress)
        return self.strategy()

    def update(self, number: int, left: float) -> TrainingProgress:
        """Play and learn once.

        Args:
            number: Number of updates before.
            left: Share of the training that is left.
        """
        rollout = self._play()
        advantages, returns = self._estimate(rollout)
        entropy = self._learn(rollout, advantages, returns, left)
        closest = self._closest
        mean = float(np.mean(closest)) if closest else float("nan")
        self._closest = []
        self._decisions += rollout.actions.size
        return TrainingProgress(number + 1, self._decisions, mean, entropy)

    def _play(self) -> Rollout:
        """Play all games for some decisions."""
        steps, games = self._settings.steps, self._games.num_envs
        width = self._observations.shape[1]
        observations = np.empty((steps + 1, games, width), np.float32)
        actions = np.empty((steps, games), np.int64)
        likelihoods = np.empty((steps, games), np.float32)
        rewards, ends = np.empty_like(likelihoods), np.empty_like(likelihoods)
        for t in range(steps):
            observations[t] = self._observations
            logits = self.actor.forward(observations[t, :, : self._sensed])
            chances = log_softmax(logits[-1])
            noise = self._random.gumbel(size=chances.shape)
            actions[t] = (chances + noise).argmax(axis=1)
            likelihoods[t] = np.take_along_axis(
                chances, actions[t][:, None], axis=1
            )[:, 0]
            found, reward, ended, late, info = self._games.step(actions[t])
            self._observations = found
            # The critic knows the time left: the time limit is an end, too.
            rewards[t], ends[t] = reward, ended | late
            if "final_info" in info:
                over = info["_final_obs"]
                self._closest += info["final_info"]["closest_m"][over].tolist()
        observations[steps] = self._observations
        return Rollout(observations, actions, likelihoods, rewards, ends)

    def _estimate(self, rollout: Rollout) -> tuple[Values, Values]:
        """Return advantages and returns of all decisions."""
        steps, games = rollout.actions.shape
        whole = rollout.observations.reshape((steps + 1) * games, -1)
        values = self.critic.forward(whole)[-1].reshape(steps + 1, games)
        trace = self._settings.trace
        advantages = np.empty_like(rollout.rewards)
        later = np.zeros(games, np.float32)
        for t in range(steps - 1, -1, -1):
            goes_on = 1.0 - rollout.ends[t]
            error = rollout.rewards[t] - values[t]
            error += goes_on * values[t + 1]
            later = error + trace * goes_on * later
            advantages[t] = later
        return advantages, advantages + values[:-1]

    def _learn(
        self,
        rollout: Rollout,
        advantages: Values,
        returns: Values,
        left: float,
    ) -> float:
        """Improve both networks; return the mean entropy of the policy."""
        settings = self._settings
        width = rollout.observations.shape[-1]
        whole = rollout.observations[:-1].reshape(-1, width)
        actions = rollout.actions.ravel()
        before = rollout.likelihoods.ravel()
        gain, goal = advantages.ravel(), returns.ravel()[:, None]
        gain = (gain - gain.mean()) / (gain.std() + 1e-8)
        rate = settings.rate * max(left, 0.1)
        entropies = []
        for _ in range(settings.epochs):
            order = self._random.permutation(len(actions))
            for at in range(0, len(order), settings.batch):
                rows = order[at : at + settings.batch]
                outputs = self.actor.forward(whole[rows, : self._sensed])
                slope, entropy = policy_slope(
                    outputs[-1],
                    (actions[rows], before[rows], gain[rows]),
                    clip=settings.clip,
                    weight=settings.entropy * left,
                )
                gradients = self.actor.gradients(outputs, slope)
                self.actor.descend(gradients, rate)
                outputs = self.critic.forward(whole[rows])
                slope = (outputs[-1] - goal[rows]) / np.float32(len(rows))
                gradients = self.critic.gradients(outputs, slope)
                self.critic.descend(gradients, rate)
                entropies.append(entropy)
        return float(np.mean(entropies))


def check_learnable(games: VectorDuel) -> None:
    """Raise an error unless the learner can learn in some games."""
    own = games.settings
    if own.action != "discrete" or not own.full_state:
        raise ValueError(
            "the learner needs action 'discrete' and full_state true, "
            f"got {own.action!r} and {own.full_state}"
        )


def log_softmax(logits: Values) -> Values:
    """Return log-probabilities. Shape (n, actions)."""
    shifted = logits - logits.max(axis=1, keepdims=True)
    found: Values = shifted - np.log(
        np.exp(shifted).sum(axis=1, keepdims=True)
    )
    return found


def policy_slope(
    logits: Values,
    taken: tuple[NDArray[np.int64], Values, Values],
    *,
    clip: float,
    weight: float,
) -> tuple[Values, float]:
    """Return the derivative of the policy's loss by its logits.

    The loss is minus the mean of min(q A, clip(q, 1 - c, 1 + c) A), with the
    ratio q of probabilities and the advantage A, minus the weighted entropy.

    Args:
        logits: Shape (n, actions).
        taken: Actions, their log-probabilities when they were taken, and
            their advantages. Each of shape (n,).
        clip: Greatest change c of a ratio.
        weight: Weight of the entropy.

    Returns:
        Derivative, of the shape of the logits, and the mean entropy.
    """
    actions, before, gain = taken
    rows = np.arange(len(actions))
    chances = log_softmax(logits)
    shares = np.exp(chances)
    ratio = np.exp(chances[rows, actions] - before)
    clipped = np.where(gain > 0.0, ratio > 1.0 + clip, ratio < 1.0 - clip)
    pull = np.where(clipped, 0.0, -gain * ratio).astype(np.float32)
    slope = -shares * pull[:, None]
    slope[rows, actions] += pull
    entropy = -(shares * chances).sum(axis=1, keepdims=True)
    slope += np.float32(weight) * shares * (chances + entropy)
    slope /= np.float32(len(actions))
    return slope, float(entropy.mean())


def main(floor: str, updates: int) -> None:
    """Train, save and rate an evader."""
    is_open = floor == "open"
    games = VectorDuel(
        512,
        role="evader",
        level="steps",
        room=ROOMS[floor],
        any_heading=is_open,
        duration=82.0,
        duel=duel(capture=0.02 if is_open else 0.35),
        first_arena=1000,  # those before are for the rating
        action="discrete",
        full_state=True,
    )
    learner = PolicyOptimiser(games, OptimisationSettings(updates), seed=1)
    curve: list[float] = []

    def note(progress: TrainingProgress) -> None:
        if len(curve) % 10 == 0:
            print(
                f"{process_time():4.0f} s: {progress.closest_m:.3f} m, "
                f"{len(curve)}"
            )
        curve.append(progress.closest_m)

    learner.train(note).save(f"evader-{floor}.onnx")
    draw_curve(curve, f"training-{floor}.png")
    study = load_study(
        "rating",
        [
            f"evader=evader-{floor}.onnx,evasion(safety_radius=100)",
            f"floor={FLOORS[floor]}",
            "pursuer=pursuit",
            f"seed=0:{max(3, updates // 2)}",
        ],
    )
    for row in run_study(study).table(values=["survived", "of_bound"]):
        over = row["of_bound"]
        print(
            f"{row['evader']} on {row['floor']}: survived "
            f"{row['survived']['share']:.2f}, closest approach over bound "
            f"{over['mean']:.3f} +- {over['half']:.3f}"
        )


def draw_curve(curve: list[float], file: str) -> None:
    """Draw the mean closest approach of the games that ended, in [m]."""
    plt.figure(figsize=(6.0, 2.6), layout="constrained")
    plt.plot(curve, color="#1f5fbf")
    plt.xlabel("update")
    plt.ylabel("closest approach [m]")
    plt.ylim(bottom=0.0)
    plt.grid(alpha=0.3)
    plt.savefig(file, dpi=120)


if __name__ == "__main__":
    floor, updates = sys.argv[1:] or ("open", "100")
    main(floor, int(updates))
