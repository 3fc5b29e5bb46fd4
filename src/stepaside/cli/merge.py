"""``stepaside merge``: the files of shards, joined."""

from pathlib import Path

import click

from .options.parameter_types import OutputFile
from .output_files import writes_files
from .terminal import echo

SUFFIX = ".sqlite"


@click.command("merge")
@click.argument(
    "files",
    metavar="FILE...",
    nargs=-1,
    required=True,
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
)
@click.option(
    "--output",
    type=OutputFile(SUFFIX),
    required=True,
    help="SQLite file of the joined records.",
)
@writes_files
def merge(files: tuple[Path, ...], output: str) -> None:
    """Join the records of the shards of a study.

    The command that ran the shards, with this output and without --shard,
    then prints the results of all cases, and runs those that are missing.
    """
    from ..studies.study import merge_results

    number = merge_results(files, Path(output))
    echo(
        f"{number} records in {output}; run the command of the shards with "
        f"--output {output} and without --shard for their results"
    )
