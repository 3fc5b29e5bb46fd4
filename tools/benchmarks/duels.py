"""Run many duels of one kind for docs/duels.md.

Like ``stepaside duels``, but with the records next to the file of results, so
that more seeds can be added later::

    python tools/benchmarks/duels.py ideal --seeds 0:1000
    python tools/benchmarks/duels.py hardware --seeds 0:200
    python tools/benchmarks/duels.py cameras --seeds 0:100

``--verify N`` repeats N recorded duels; if all agree to the bit, the records
of an older version of the code are reused. ``--summarise`` only recomputes
the summary from the records.
"""

from collections.abc import Sequence
from hashlib import sha256
from pathlib import Path
from typing import Any

from asking import ask, seeds_of
from tqdm import tqdm

from stepaside.core.worker_pool import worker_pool
from stepaside.games.configuration_file import json_settings
from stepaside.games.duel_settings import DuelSettings
from stepaside.locomotion.zmp.control_settings import ControlSettings
from stepaside.sim.body_settings import BODIES
from stepaside.studies.duel_campaign import (
    run_duels,
    settings_hash,
    verify_duels,
    versions_of,
)
from stepaside.studies.duel_statistics import summarise_duels
from stepaside.studies.record_store import RecordStore
from stepaside.studies.result_files import header, read_result, write_result

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


def summarise(output: Path, settings: DuelSettings) -> None:
    """Recompute the summary of a result from its records.

    Args:
        output: Result file, which names its records.
        settings: Settings of its duels.
    """
    result = read_result(output)
    file = RecordStore(output.with_suffix(".jsonl"))
    found, kind = file.read(), result["records"]["settings"]
    seeds = range(*result["settings"]["seeds"])
    records = [found[f"{seed}/{kind}"] for seed in seeds]
    if digest_of(records) != result["records"]["digest"]:
        raise SystemExit(f"{file.path} holds other duels than {output}")
    summary = summarise_duels(settings, records)
    write_result(output, result | {"summary": summary})


def main() -> None:
    """Run the duels and write the results."""
    parser = ask(__doc__, lambda given: f"duels-{given.kind}.json")
    parser.add_argument("kind", choices=list(KINDS))
    parser.add_argument("--seeds", type=seeds_of, default=range(0, 40))
    parser.add_argument("--verify", type=int)
    parser.add_argument("--summarise", action="store_true")
    parser.add_argument("--workers", type=int)
    asked = parser.parse_args()
    output = asked.output
    settings, seeds = KINDS[asked.kind], asked.seeds
    if asked.summarise:
        summarise(output, settings)
        return
    file = RecordStore(output.with_suffix(".jsonl"))
    with (
        worker_pool(asked.workers) as executor,
        tqdm(total=len(seeds), unit="duel", disable=None) as bar,
    ):
        if asked.verify is not None:
            _, differ = verify_duels(settings, file, asked.verify, executor)
            print(f"came out otherwise: seeds {differ}")

        def report(number: int) -> None:
            bar.n = number
            bar.refresh()

        found = run_duels(settings, seeds, file, executor, report)
    records = list(found.values())
    entries = json_settings(settings) | {"seeds": [seeds.start, seeds.stop]}
    write_result(
        output,
        header(entries),
        played_by=versions_of(records),
        records={
            "file": file.path.name,
            "settings": settings_hash(settings),
            "digest": digest_of(records),
        },
        summary=summarise_duels(settings, records),
    )


if __name__ == "__main__":
    main()
