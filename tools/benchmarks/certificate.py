"""Measure the fraction of random starts that the certificate covers.

Writes ``docs/results/certificate.json`` for docs/unicycles.md::

    python tools/benchmarks/certificate.py
"""

from math import pi, radians

import numpy as np
from benchmark_options import ask
from result_files import header, write_result

from stepaside.theory.unicycle import RelativeStart, Unicycles
from stepaside.theory.unicycle.certificate import certify

BOXES = {
    "any headings, 0.15-2 m": (0.15, 2.0, pi, pi),
    "facing (±30.5°), pursuer aiming (±30°), 0.8-2 m": (
        0.8,
        2.0,
        radians(30.0),
        radians(30.5),
    ),
    "the same, 0.8-1.2 m": (0.8, 1.2, radians(30.0), radians(30.5)),
}
COUNT, SEED = 4000, 1


def main() -> None:
    """Certify random starts under the parameters of Sec. IV."""
    output = ask(__doc__, "certificate.json").parse_args().output
    rows = []
    for name, (low, high, aim, facing) in BOXES.items():
        rng = np.random.default_rng(SEED)
        r = rng.uniform(low, high, COUNT)
        a = rng.uniform(-aim, aim, COUNT)
        psi = rng.uniform(-facing, facing, COUNT)
        starts = [RelativeStart(*row) for row in zip(r, a, psi, strict=True)]
        row: dict[str, object] = {"starts": name}
        inside = np.abs(a) + np.abs(psi) < pi
        row["in the diamond"] = float(inside.mean())
        for rule in ("latched", "behind"):
            game = Unicycles(0.1, 0.1, 0.2, 0.2, side_rule=rule)
            row[f"certain, {rule}"] = float(
                np.mean([certify(game, s) is not None for s in starts])
            )
        rows.append(row)
    settings = {
        "speed_m_s": 0.1,
        "gain_per_s": 0.2,
        "angle_rad": pi / 2,
        "starts": COUNT,
        "seed": SEED,
    }
    head = header(settings)
    write_result(output, head, rows=rows)


if __name__ == "__main__":
    main()
