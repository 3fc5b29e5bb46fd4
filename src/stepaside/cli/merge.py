"""``stepaside merge``: the outputs of shards, joined."""

from pathlib import Path

import click

from ..core.atomic_output import check_folder
from ..core.errors import ConfigurationError
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
    from ..studies.study import merge_results

    files = [sorted(each.glob("*.sqlite")) for each in outputs]
    for each in outputs:
        if not has_records(each):
            raise ConfigurationError(
                f"OUTPUT must be a folder of results, got {each}, which has "
                "no records"
            )
    check_folder(output, new=False)
    number = 0
    for name in dict.fromkeys(file.name for f in files for file in f):
        parts = [each / name for each in outputs if (each / name).is_file()]
        number += merge_results(parts, output / name)
    echo(
        f"{number} records in {output}; run the command of the shards with "
        f"--output {output} and without --shard for their results"
    )
