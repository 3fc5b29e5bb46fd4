"""Update the generated parts of README and docs/ from docs/results/.

``make figures`` runs this; ``--check`` changes nothing and reports what is out
of date; ``--versions`` reports results of another results version.
"""

import sys
from argparse import ArgumentParser

from stepaside.studies.results_version import RESULTS

from .document import complaints, documents, remade
from .pictures import IMAGES, PICTURES, draw_picture, drawn_from
from .store import ROOT, Store


def main() -> int:
    """Update or check; return 1 if something is out of date."""
    parser = ArgumentParser(
        prog="python -m tools.documents", description=__doc__
    )
    choice = parser.add_mutually_exclusive_group()
    choice.add_argument("--check", action="store_true")
    choice.add_argument("--versions", action="store_true")
    arguments = parser.parse_args()
    store = Store()
    if arguments.versions:
        return _say(old_results(store))
    if not arguments.check:
        write_all(store)
    return _say(check_all(store))


def write_all(store: Store) -> None:
    """Write every document and figure that is out of date."""
    for file in documents():
        text = file.read_text(encoding="utf-8")
        new = remade(text, store)
        if new != text:
            file.write_text(new, encoding="utf-8")
            print(f"wrote {file.relative_to(ROOT)}")
    for name in sorted(PICTURES):
        if measured(name, store) and draw_picture(name, store):
            print(f"drew docs/images/{name}")


def check_all(store: Store) -> list[str]:
    """Return messages about documents and figures that are out of date."""
    found = [c for file in documents() for c in complaints(file, store)]
    for name, picture in sorted(PICTURES.items()):
        if not measured(name, store):
            continue
        wanted, file = picture.source(store), IMAGES / name
        got = drawn_from(file) if file.exists() else "no picture"
        if got != wanted:
            found.append(f"docs/images/{name}: wanted {wanted}, got {got!r}")
    return found


def measured(name: str, store: Store) -> bool:
    """Return whether all results of a figure exist."""
    return set(PICTURES[name].results) <= set(store.names())


def old_results(store: Store) -> list[str]:
    """Return messages about results of another version, with commands."""
    results = {name: store.result(name) for name in store.names()}
    return [
        f"{name}: made with another version; again by: {result['command']}"
        for name, result in results.items()
        if result.get("results") != RESULTS
    ]


def _say(messages: list[str]) -> int:
    for message in messages:
        print(message, file=sys.stderr)
    return 1 if messages else 0


if __name__ == "__main__":
    raise SystemExit(main())
