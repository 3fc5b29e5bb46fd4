"""Execute the tutorials of docs/tutorials/ and keep their outputs.

``make docs-run`` runs this. A tutorial is a script in the percent format of
jupytext; its outputs are the notebook beside it. The notebook stores
a fingerprint of the script and the results version, by which ``make docs``
refuses outputs that are older than either.
"""

import os
import sys
from argparse import ArgumentParser
from base64 import b64decode, b64encode
from collections.abc import Iterable
from hashlib import sha256
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from stepaside.studies.results_version import RESULTS

from .store import ROOT

TUTORIALS = ROOT / "docs" / "tutorials"
TIMEOUT = 900  # of a cell, in [s]
PNG = "image/png"
OBJECT = "<matplotlib."  # beginning of what such an object shows
KEY = "stepaside"  # of our entry in a notebook's metadata


def main() -> int:
    """Execute tutorials whose outputs are out of date, or those named."""
    parser = ArgumentParser(
        prog="python -m tools.documents.notebooks", description=__doc__
    )
    parser.add_argument("names", nargs="*", help="tutorials; default: stale")
    parser.add_argument("--check", action="store_true", help="only report")
    arguments = parser.parse_args()
    if arguments.check:
        found = complaints()
        print(*found, sep="\n", file=sys.stderr)
        return 1 if found else 0
    for script in scripts():
        if script.stem in arguments.names or (
            not arguments.names and complaint(script)
        ):
            print(f"running {script.relative_to(ROOT)}", flush=True)
            execute(script)
    return 0


def scripts() -> list[Path]:
    """Return the scripts of all tutorials, in the order of their names."""
    return sorted(TUTORIALS.glob("*.py"))


def fingerprint(script: Path) -> dict[str, str]:
    """Return what the outputs of a tutorial depend on."""
    text = script.read_text(encoding="utf-8")
    return {
        "script": sha256(text.encode()).hexdigest()[:12],
        "results": RESULTS,
    }


def complaint(script: Path) -> str | None:
    """Return why the outputs of a tutorial cannot be used, or None."""
    import nbformat

    name = script.relative_to(ROOT)
    again = f"run: make docs-run ONLY={script.stem}"
    file = script.with_suffix(".ipynb")
    if not file.exists():
        return f"{name} has no outputs; {again}"
    stored = nbformat.read(file, as_version=4).metadata.get(KEY, {})
    for kind, wanted in fingerprint(script).items():
        if stored.get(kind) != wanted:
            return f"{name}: its outputs are of another {kind}; {again}"
    return None


def complaints() -> list[str]:
    """Return why outputs of tutorials cannot be used."""
    return [text for script in scripts() if (text := complaint(script))]


def execute(script: Path) -> None:
    """Execute a tutorial in an empty folder and write its notebook.

    Raises:
        CellExecutionError: If a cell raises; the old notebook stays.
    """
    import jupytext
    import nbformat
    from nbclient import NotebookClient

    notebook = jupytext.read(script, fmt="py:percent")
    # Cells find the command of this environment.
    path = [str(Path(sys.executable).parent), os.environ["PATH"]]
    os.environ["PATH"] = os.pathsep.join(path)
    os.environ["PYTHONPATH"] = str(ROOT / "examples")
    with TemporaryDirectory() as folder:
        NotebookClient(
            notebook,
            timeout=TIMEOUT,
            kernel_name="python3",
            resources={"metadata": {"path": folder}},
        ).execute()
    _tidy(notebook.cells)
    notebook.metadata = {
        "kernelspec": {
            "name": "python3",
            "language": "python",
            "display_name": "Python 3",
        },
        "language_info": {"name": "python", "pygments_lexer": "ipython3"},
        KEY: fingerprint(script),
    }
    nbformat.write(notebook, script.with_suffix(".ipynb"))


def _tidy(cells: Iterable[Any]) -> None:
    """Remove from cells what differs from run to run; shrink images."""
    for number, cell in enumerate(cells):
        cell["id"] = f"cell-{number}"
        cell["metadata"].pop("execution", None)
        if cell["cell_type"] == "code":
            cell["outputs"] = _joined(cell["outputs"])
            for output in cell["outputs"]:
                if PNG in output.get("data", {}):
                    output["data"][PNG] = _with_palette(output["data"][PNG])


def _joined(outputs: Iterable[Any]) -> list[Any]:
    """Join what was printed in pieces.

    Standard error and objects of Matplotlib, which only have an address, are
    left out.
    """
    joined: list[Any] = []
    for output in outputs:
        shown = output.get("data", {}).get("text/plain", "")
        if output.get("name") == "stderr" or shown.startswith(OBJECT):
            continue
        if joined and output.get("name") == joined[-1].get("name", "none"):
            joined[-1]["text"] += output["text"]
        else:
            joined.append(output)
    return joined


def _with_palette(png: str) -> str:
    """Reduce an image to 256 colours; both are PNG in base 64."""
    from PIL import Image

    buffer = BytesIO()
    with Image.open(BytesIO(b64decode(png))) as image:
        few = image.convert("RGB").quantize(256, dither=Image.Dither.NONE)
        few.save(buffer, "PNG", optimize=True)
    return b64encode(buffer.getvalue()).decode()


if __name__ == "__main__":
    raise SystemExit(main())
