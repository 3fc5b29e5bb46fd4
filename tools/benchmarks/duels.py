"""Run many duels of one kind for docs/duels.md.

Like ``stepaside duels``, but with the records in a folder next to the file of
results, so that more seeds can be added later::

    python tools/benchmarks/duels.py ideal --seeds 0:1000
    python tools/benchmarks/duels.py hardware --seeds 0:200
    python tools/benchmarks/duels.py cameras --seeds 0:100

``--summarise`` only recomputes the summary from the records.
"""

from collections.abc import Sequence
from hashlib import sha256
from pathlib import Path
from typing import Any

from benchmark_options import ask, seeds_of
from resumable_jobs import complete

from stepaside.games.configuration_file import json_settings
from stepaside.games.duel_settings import DuelSettings
from stepaside.locomotion.zmp.control_settings import ControlSettings
from stepaside.sim.body_settings import BODIES
from stepaside.studies.duel_campaign import duel_study, versions_of
from stepaside.studies.duel_record import settings_hash
from stepaside.studies.duel_statistics import summarise_duels
from stepaside.studies.result_files import header, read_result, write_result
from stepaside.studies.result_store import (
    MERGED,
    SUFFIX,
    ResultStore,
    merge_stores,
)

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
    store = ResultStore(output.with_suffix(""))
    found, kind = store.read(), result["records"]["settings"]
    seeds = range(*result["settings"]["seeds"])
    records = [found[f"{seed}/{kind}"] for seed in seeds]
    if digest_of(records) != result["records"]["digest"]:
        raise SystemExit(f"{store.folder} holds other duels than {output}")
    summary = summarise_duels(settings, records)
    write_result(output, result | {"summary": summary})


def compact(store: ResultStore) -> None:
    """Join the files of a store, to which nothing else writes."""
    merge_stores([store], store)
    for file in store.folder.glob(f"*{SUFFIX}"):
        if file.name != MERGED:
            file.unlink()


def main() -> None:
    """Run the duels and write the results."""
    parser = ask(__doc__, lambda given: f"duels-{given.kind}.json")
    parser.add_argument("kind", choices=list(KINDS))
    parser.add_argument("--seeds", type=seeds_of, default=range(0, 40))
    parser.add_argument("--summarise", action="store_true")
    parser.add_argument("--workers", type=int)
    asked = parser.parse_args()
    output = asked.output
    settings, seeds = KINDS[asked.kind], asked.seeds
    if asked.summarise:
        summarise(output, settings)
        return
    store = ResultStore(output.with_suffix(""))
    study = duel_study(settings, seeds)
    run = complete(study, store, asked.workers)
    records = list(run.records())
    compact(store)
    entries = json_settings(settings) | {"seeds": [seeds.start, seeds.stop]}
    write_result(
        output,
        header(entries),
        played_by=versions_of(records),
        records={
            "folder": store.folder.name,
            "settings": settings_hash(settings),
            "digest": digest_of(records),
        },
        summary=summarise_duels(settings, records),
    )


if __name__ == "__main__":
    main()
