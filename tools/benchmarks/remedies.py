"""Simulate remedies against a close reversed circle, for docs/unicycles.md.

Like ``stepaside circle --remedies``, into a file of results::

    python tools/benchmarks/remedies.py
"""

from benchmark_options import ask

from stepaside.cli.circle_tables import describe_circles, describe_remedies
from stepaside.cli.unicycle_options import describe_game
from stepaside.studies.result_files import header, write_result
from stepaside.theory.unicycle.unicycle_game import make_game

GAME = make_game(2.0, 1.0, 1.0, 4.0)  # twice as fast, a quarter the gain


def main() -> None:
    """Simulate the same initial poses with every remedy."""
    parser = ask(__doc__, "circle-remedies.json")
    parser.add_argument("--starts", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--body", type=float, default=0.1, help="[m]")
    asked = parser.parse_args()
    settings = {
        "game": describe_game(GAME),
        "starts": asked.starts,
        "seed": asked.seed,
        "body_m": asked.body,
    }
    drawn = asked.starts, asked.seed, asked.body
    modules = ("cli/circle_tables", "cli/unicycle_options")
    write_result(
        asked.output,
        header(settings, modules=modules, libraries=("numpy", "numba")),
        starts=describe_circles(GAME, *drawn)["starts"],
        rows=describe_remedies(GAME, *drawn),
    )


if __name__ == "__main__":
    main()
