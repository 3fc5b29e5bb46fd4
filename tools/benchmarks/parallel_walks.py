"""Many walks in parallel, and the values stored of them."""

from argparse import Namespace
from collections.abc import Mapping
from typing import Any

from resumable_jobs import Row, finished, gather

from stepaside.games.recorded_game import run_walk
from stepaside.games.run_archive import results_of
from stepaside.games.walk_settings import WalkSettings
from stepaside.studies.result_files import header, write_result


def walk(settings: WalkSettings) -> Row:
    """Return the values of one walk."""
    found: Row = results_of(run_walk(settings))
    found |= found["planning"] | found["walking"]
    return found


def walk_all(
    arguments: Namespace,
    settings: dict[str, Any],
    jobs: Mapping[str, WalkSettings],
    kept: tuple[str, ...],
) -> None:
    """Simulate the walks and write the results.

    Args:
        arguments: Parsed arguments with output and workers.
        settings: Settings for the header of the result.
        jobs: Walks by name.
        kept: Names of the values to store.
    """
    head = header(settings)
    whole = gather(arguments.output, head, jobs, walk, arguments.workers)
    walks = {
        name: {key: row[key] for key in kept} for name, row in whole.items()
    }
    falls = sum(row["outcome"] != "completed" for row in walks.values())
    write_result(arguments.output, head, falls=falls, walks=walks)
    finished(arguments.output)
