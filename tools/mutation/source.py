"""Source text of a module with its syntax tree, and edits of it."""

import ast
from dataclasses import dataclass
from itertools import accumulate

Node = ast.expr | ast.stmt | ast.keyword


@dataclass(frozen=True, slots=True)
class Edit:
    """Replacement of some bytes of a file.

    Attributes:
        operator: Kind of fault.
        start: Offset of the first replaced byte.
        end: Offset after the last replaced byte.
        text: New text.
    """

    operator: str
    start: int
    end: int
    text: str


class Source:
    """Source text with access by node.

    Args:
        text: Text of a module.
    """

    def __init__(self, text: str) -> None:
        self.data = text.encode()
        self.tree = ast.parse(text)
        lengths = [len(row) for row in self.data.splitlines(keepends=True)]
        self._offsets = [0, *accumulate(lengths)]

    def span(self, node: Node) -> tuple[int, int]:
        """Return the byte offsets of a node: first, and one past the last."""
        assert node.end_lineno is not None
        assert node.end_col_offset is not None
        return (
            self._offsets[node.lineno - 1] + node.col_offset,
            self._offsets[node.end_lineno - 1] + node.end_col_offset,
        )

    def text(self, node: Node) -> str:
        """Return the text of a node."""
        start, end = self.span(node)
        return self.data[start:end].decode()

    def line(self, offset: int) -> int:
        """Return the line number of an offset, from one."""
        return self.data.count(b"\n", 0, offset) + 1

    def replace(self, operator: str, node: Node, text: str) -> Edit:
        """Return an edit that replaces a node."""
        return Edit(operator, *self.span(node), text)

    def between(
        self,
        operator: str,
        left: ast.expr,
        right: ast.expr,
        old: str,
        new: str,
    ) -> Edit | None:
        """Return an edit of the operator between two expressions."""
        start, end = self.span(left)[1], self.span(right)[0]
        at = self.data.find(old.encode(), start, end)
        if at < 0 or b"#" in self.data[start:end]:
            return None
        return Edit(operator, at, at + len(old), new)

    def apply(self, edit: Edit) -> str:
        """Return the text of the module after an edit."""
        data = self.data[: edit.start] + edit.text.encode()
        return (data + self.data[edit.end :]).decode()

    def lines_around(self, edit: Edit) -> tuple[str, str]:
        """Return the lines before and after an edit, whitespace folded."""
        first = self.data.rfind(b"\n", 0, edit.start) + 1
        last = self.data.find(b"\n", edit.end)
        before = self.data[first:last].decode()
        head = self.data[first : edit.start].decode()
        after = head + edit.text + self.data[edit.end : last].decode()
        return " ".join(before.split()), " ".join(after.split())
