"""Generated blocks of documents: tables, lists and code fences.

A block stands between ``<!-- made: NAME.TABLE -->`` and ``<!-- /made -->``:
TABLE is a key of ``documents.tables.TABLES``, NAME the result that it is made
from. Several results are joined by ``+``; ``all`` stands for every one.
"""

import re
from collections.abc import Iterator

from .parts import Part
from .store import DocumentError, Store
from .tables import TABLES

BEGIN, END = "<!-- made:", "<!-- /made -->"
BLOCK = re.compile(
    r"<!-- made: (?P<source>(?P<names>[\w+-]+)\.(?P<table>[\w-]+)) -->\n"
    r"(?P<body>(?:(?!<!-- made:).)*?)<!-- /made -->",
    re.DOTALL,
)

BUILT = re.compile(r"<!-- built: (?P<names>[\w+-]+)\.(?P<table>[\w-]+) -->")


def with_tables(text: str, store: Store) -> str:
    """Return a text with the tables that only the built site shows.

    Args:
        text: Text with marks like ``<!-- built: all.settings -->``.
        store: Results that the marks name.
    """
    return BUILT.sub(lambda m: make(m["names"], m["table"], store), text)


def block_parts(text: str, store: Store) -> Iterator[Part]:
    """Yield every generated block of a document.

    Args:
        text: Text of the document.
        store: Results that the blocks name.
    """
    read = set()
    for match in BLOCK.finditer(text):
        read |= {match.start(), match.end() - len(END)}
        wanted, problem = None, ""
        try:
            made = make(match["names"], match["table"], store)
            wanted = f"\n{made.strip()}\n\n"
        except DocumentError as error:
            problem = str(error)
        start = match.start("body")
        yield Part(start, match["body"], wanted, match["source"], problem)
    for match in re.finditer(f"{BEGIN}|{END}", text):
        if match.start() not in read:
            problem = f"a block must read {BEGIN} NAME.TABLE -->, {END}"
            yield Part(match.start(), "", None, match[0], problem)


def make(names: str, table: str, store: Store) -> str:
    """Return the text of one block.

    Args:
        names: Results, joined by ``+``; or ``all``.
        table: Kind of the table.
        store: Results.

    Raises:
        DocumentError: If table or result does not exist, or the result lacks
            an entry of the table.
    """
    if table not in TABLES:
        known = ", ".join(sorted(TABLES))
        raise DocumentError(f"no table {table!r}; there are {known}")
    if names == "all":
        results = [{name: store.result(name) for name in store.names()}]
    else:
        results = [store.result(name) for name in names.split("+")]
    try:
        return TABLES[table](*results)
    except (KeyError, IndexError, TypeError, ValueError) as error:
        raise DocumentError(
            f"{names} does not hold what {table!r} shows: {error!r}"
        ) from error
