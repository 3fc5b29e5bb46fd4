"""``stepaside legs convert``: a TorchScript policy as ONNX."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.atomic_output import atomic_draft
from .options.common_options import json_option
from .options.parameter_types import OutputFile
from .output_files import attempt, writes_files
from .tables import print_table
from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..locomotion.policy.torchscript_conversion import ConvertedNetwork


def _beside_archive(
    context: click.Context, _: click.Parameter, given: str | None
) -> str:
    """Return the given output, or the archive with another suffix."""
    archive: Path = context.params["archive"]
    return given or str(archive.with_suffix(".onnx"))


@click.command("convert")
@click.argument(
    "archive",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    is_eager=True,
)
@click.option(
    "--output",
    type=OutputFile(".onnx"),
    callback=_beside_archive,
    help="File to write.  [default: ARCHIVE with suffix .onnx]",
)
@click.option(
    "--legs-contract", default="", help="Name of the convention to note."
)
@click.option(
    "--deployment",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="YAML file of the trainer with gains, scales and posture; needs "
    "--legs-contract.",
)
@click.option(
    "--width",
    type=click.IntRange(1, 100_000),
    help="Width of the observation; by default that of the first layer.",
)
@json_option
@writes_files
def convert(
    archive: Path,
    output: str,
    legs_contract: str,
    deployment: Path | None,
    width: int | None,
    as_json: bool,
) -> None:
    """Convert the walking policy ARCHIVE (TorchScript) to ONNX.

    Reads the file that torch.jit.save writes; PyTorch is not needed, and no
    code of the archive is executed. Convention and deployment file become
    metadata of the network.
    """
    from ..locomotion.policy.deployment_file import read_deployment
    from ..locomotion.policy.network import PolicyNetwork
    from ..locomotion.policy.torchscript_conversion import (
        convert_torchscript,
        write_network,
    )
    from ..locomotion.policy.trainer_conventions import find_convention

    entries: dict[str, Any] = {}
    if legs_contract:
        used = find_convention(legs_contract)
        entries["convention"] = used.name
        if deployment is not None:
            entries |= read_deployment(deployment, used)
    elif deployment is not None:
        raise click.UsageError("--deployment needs --legs-contract")
    network = convert_torchscript(archive, width)

    def write() -> None:
        with atomic_draft(Path(output)) as draft:
            write_network(network, draft, _metadata(entries))
            PolicyNetwork(draft)  # refuses what cannot be evaluated

    _report(network, output if attempt(write) else None, as_json)


def _metadata(entries: dict[str, Any]) -> dict[str, str]:
    """Return entries of a contract as metadata of a network."""
    from ..locomotion.policy.contract_reader import OWN_ENTRY

    return {OWN_ENTRY: json.dumps(entries)} if entries else {}


def _report(
    network: "ConvertedNetwork", output: str | None, as_json: bool
) -> None:
    """Print the inputs and outputs of the new network, and its file."""
    observation, *states = map(str, network.inputs)
    facts = {"input": observation, "output": str(network.outputs[0])}
    if as_json:
        print_json(facts | {"recurrent": states, "file": output})
        return
    rows = list(facts.items())
    print_table(rows + [("recurrent state", state) for state in states])
    if output is not None:
        echo(f"wrote {output}")
