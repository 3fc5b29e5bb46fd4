# /// script
# dependencies = ["stepaside[fast]"]
# ///
"""How near several pursuers come to one evader, by their number.

All are unicycles under the paper's laws at equal speeds and gains; the evader
moves aside from the nearest pursuer. Pursuers begin 2 to 4 v/k away, in
random directions. Distances are in units of v/k.
"""

from math import pi

import numpy as np

from stepaside.theory.teams.team_game import play_team_games
from stepaside.theory.teams.team_players import TeamPlayer

GAMES, DURATION = 2000, 40.0  # duration in units of 1/k
PURSUER = TeamPlayer(speed=1.0, gain=1.0)
EVADER = TeamPlayer(speed=1.0, gain=1.0, evades=True)
CIRCLE = 4.0 * np.sin(pi / 4.0) / (pi / 2.0)  # distance for one pursuer


def starts(pursuers: int, generator: np.random.Generator) -> np.ndarray:
    """Draw initial poses, the evader's last. Shape (games, players, 3)."""
    poses = np.zeros((GAMES, pursuers + 1, 3))
    away = generator.uniform(2.0, 4.0, (GAMES, pursuers))
    angle = generator.uniform(-pi, pi, (GAMES, pursuers))
    poses[:, :-1, 0] = away * np.cos(angle)
    poses[:, :-1, 1] = away * np.sin(angle)
    poses[:, :, 2] = generator.uniform(-pi, pi, (GAMES, pursuers + 1))
    return poses


def main() -> None:
    """Play the games and print the closest approaches."""
    generator = np.random.default_rng(0)
    print(f"distances in [v/k]; on the circle of one pursuer {CIRCLE:.3f}")
    print("pursuers  median  tenth  below 0.2  final distance")
    for count in (1, 2, 3, 4, 6, 8):
        players = [PURSUER] * count + [EVADER]
        out = play_team_games(players, starts(count, generator), DURATION)
        closest = out.closest_to(count, range(count))
        offsets = out.poses[:, :count, :2] - out.poses[:, count:, :2]
        final = np.hypot(offsets[..., 0], offsets[..., 1]).min(axis=1)
        print(
            f"{count:8}  {np.median(closest):6.3f}  "
            f"{np.quantile(closest, 0.1):5.3f}  "
            f"{np.mean(closest < 0.2):9.3f}  {np.median(final):14.3f}"
        )


if __name__ == "__main__":
    main()
