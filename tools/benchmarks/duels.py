"""Run many duels of one kind for docs/duels.md.

Like ``stepaside duels``, but with the records next to the file of results::

    python tools/benchmarks/duels.py ideal --seeds 0:1000
    python tools/benchmarks/duels.py hardware --seeds 0:200
    python tools/benchmarks/duels.py cameras --seeds 0:100
"""

import json
from collections.abc import Sequence
from hashlib import sha256
from typing import Any

from benchmark_options import ask, seeds_of
from resumable_jobs import complete, part_of

from stepaside.core.atomic_output import atomic_draft
from stepaside.games.configuration_file import json_settings
from stepaside.games.duel_settings import DuelSettings
from stepaside.locomotion.zmp.control_settings import ControlSettings
from stepaside.sim.body_settings import BODIES
from stepaside.studies.duel_campaign import duel_study
from stepaside.studies.duel_statistics import summarise_duels
from stepaside.studies.result_files import header, write_result

KINDS = {
    "ideal": DuelSettings(),
    "hardware": DuelSettings(
        body=BODIES["hardware"],
        control=ControlSettings(method="measured", feedback=True),
    ),
    "cameras": DuelSettings(sensing="cameras"),
}


def digest_of(records: Sequence[dict[str, Any]]) -> str:
    """Return a hash of the trajectories of some duels."""
    digests = " ".join(record["digest"] for record in records)
    return sha256(digests.encode()).hexdigest()[:12]


def main() -> None:
    """Run the duels and write the results."""
    parser = ask(__doc__, lambda given: f"duels-{given.kind}.json")
    parser.add_argument("kind", choices=list(KINDS))
    parser.add_argument("--seeds", type=seeds_of, default=range(0, 40))
    parser.add_argument("--workers", type=int)
    asked = parser.parse_args()
    output = asked.output
    settings, seeds = KINDS[asked.kind], asked.seeds
    study = duel_study(settings, seeds)
    run = complete(study, part_of(output), asked.workers)
    records = list(run.records())
    lines = output.with_suffix(".jsonl")
    with atomic_draft(lines) as draft:
        draft.write_text("".join(json.dumps(r) + "\n" for r in records))
    entries = json_settings(settings) | {"seeds": [seeds.start, seeds.stop]}
    write_result(
        output,
        header(entries),
        digest=digest_of(records),
        summary=summarise_duels(settings, records),
    )


if __name__ == "__main__":
    main()
