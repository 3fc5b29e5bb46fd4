"""``stepaside merge``: the outputs of shards, joined."""

from pathlib import Path

import click

from ..core.atomic_output import check_folder
from ..core.errors import ConfigurationError
from .campaign_options import RECORDS
from .campaign_reports import report_invalid_lines
from .output_files import has_records
from .terminal import echo


@click.command("merge")
@click.argument(
    "outputs",
    metavar="OUTPUT...",
    nargs=-1,
    required=True,
    type=click.Path(exists=True, file_okay=False, path_type=Path),
)
@click.option(
    "--output",
    required=True,
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder of the joined results.",
)
def merge(outputs: tuple[Path, ...], output: Path) -> None:
    """Join the records in the outputs of shards.

    The command that ran the shards, with this output and without --shard,
    then prints the results of all cases, and runs those that are missing.
    """
    from ..studies.result_store import ResultStore, merge_stores

    for each in outputs:
        if not has_records(each / RECORDS):
            raise ConfigurationError(
                f"OUTPUT must be a folder of results, got {each}, which has "
                "no records"
            )
    check_folder(output, new=False)
    whole = ResultStore(output / RECORDS)
    stores = [ResultStore(each / RECORDS) for each in outputs]
    if output.resolve() not in (each.resolve() for each in outputs):
        stores.append(whole)  # of an earlier merging
    found = any(True for store in stores for _ in store.entries())
    number = merge_stores(stores, whole) if found else 0
    for store in stores:
        report_invalid_lines(store)
    if not found:
        raise ConfigurationError("OUTPUT must have a valid record, got none")
    echo(
        f"{number} records in {output}; run the command of the shards with "
        f"--output {output} and without --shard for their results"
    )
