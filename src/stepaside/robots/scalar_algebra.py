"""Linear algebra on lists of scalars, which may be traced numbers."""

from collections.abc import Sequence

from .expression_tracing import Number, cosine, hint_of, sine

Vector = Sequence[Number]
Matrix = Sequence[Vector]  # rows
PIVOT = 0.3  # least pivot relative to the largest entry of its row


def add(a: Vector, b: Vector) -> list[Number]:
    """Add two vectors."""
    return [x + y for x, y in zip(a, b, strict=True)]


def subtract(a: Vector, b: Vector) -> list[Number]:
    """Subtract two vectors."""
    return [x - y for x, y in zip(a, b, strict=True)]


def scale(factor: Number, a: Vector) -> list[Number]:
    """Scale a vector."""
    return [factor * x for x in a]


def dot(a: Vector, b: Vector) -> Number:
    """Return the inner product of two vectors."""
    total: Number = 0.0
    for x, y in zip(a, b, strict=True):
        total = total + x * y
    return total


def cross(a: Vector, b: Vector) -> list[Number]:
    """Return the cross product of two vectors."""
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


def transpose(a: Matrix) -> list[list[Number]]:
    """Transpose a matrix."""
    return [list(column) for column in zip(*a, strict=True)]


def turn(a: Matrix, b: Vector) -> list[Number]:
    """Return the product of a matrix and a vector."""
    return [dot(row, b) for row in a]


def multiply(a: Matrix, b: Matrix) -> list[list[Number]]:
    """Return the product of two matrices."""
    return transpose([turn(a, column) for column in transpose(b)])


def rotation_about(axis: Sequence[float], angle: Number) -> list[list[Number]]:
    """Return the rotation by an angle, in [rad], about a unit axis.

    Rodrigues' formula, arranged so that entries 0 and 1 are exact for a
    coordinate axis.
    """
    x, y, z = axis
    c, s = cosine(angle), sine(angle)
    rest = 1.0 - c

    def along(a: float) -> Number:
        return a * a + (1.0 - a * a) * c

    return [
        [along(x), x * y * rest - z * s, x * z * rest + y * s],
        [x * y * rest + z * s, along(y), y * z * rest - x * s],
        [x * z * rest - y * s, y * z * rest + x * s, along(z)],
    ]


class LuFactors:
    """LU factors of a square matrix with sparse pivoting.

    Traced entries are compared by their hints, and constant zeros are
    skipped, so that structure (intersecting hip axes, parallel pitch axes)
    saves operations. The order of elimination is fixed by the trace.
    """

    def __init__(self, matrix: Matrix) -> None:
        """Factorise by Gaussian elimination.

        Raises:
            ZeroDivisionError: If the matrix is singular.
        """
        rows = [list(row) for row in matrix]
        left = list(range(len(rows)))
        columns = list(range(len(rows)))
        self._inverses: list[Number] = []  # of the pivots
        # (pivot row, its column, [(other row, multiplier)])
        self._steps: list[tuple[int, int, list[tuple[int, Number]]]] = []
        while left:
            row, column = _pivot(rows, left, columns)
            left.remove(row)
            columns.remove(column)
            multipliers = []
            pivot = rows[row][column]
            inverse = 1.0 / pivot
            for other in left:
                entry = rows[other][column]
                if _is_zero(entry):
                    continue
                # The same node: a constant 1, as with parallel axes.
                factor = 1.0 if entry is pivot else entry * inverse
                multipliers.append((other, factor))
                for k in columns:
                    rows[other][k] = rows[other][k] - factor * rows[row][k]
            self._steps.append((row, column, multipliers))
            self._inverses.append(inverse)
        self._rows = rows

    def solve(self, right: Vector) -> list[Number]:
        """Solve A x = b."""
        b = list(right)
        for row, _, multipliers in self._steps:
            for other, factor in multipliers:
                b[other] = b[other] - factor * b[row]
        x: list[Number] = [0.0] * len(b)
        done: list[int] = []
        for step in range(len(b) - 1, -1, -1):
            row, column, _ = self._steps[step]
            total = b[row]
            for k in done:
                total = total - self._rows[row][k] * x[k]
            x[column] = total * self._inverses[step]
            done.append(column)
        return x

    def solve_transposed(self, right: Vector) -> list[Number]:
        """Solve A' x = b."""
        b = list(right)
        x: list[Number] = [0.0] * len(b)
        columns = [column for _, column, _ in self._steps]
        for step, (row, column, _) in enumerate(self._steps):
            x[row] = b[column] * self._inverses[step]
            for k in columns[step + 1 :]:
                b[k] = b[k] - self._rows[row][k] * x[row]
        for row, _, multipliers in reversed(self._steps):
            for other, factor in multipliers:
                x[row] = x[row] - factor * x[other]
        return x


def _is_zero(number: Number) -> bool:
    return isinstance(number, float) and number == 0.0


def _pivot(
    rows: list[list[Number]], left: list[int], columns: list[int]
) -> tuple[int, int]:
    """Return row and column of the pivot with the least fill-in."""
    best: tuple[float, float, int, int] | None = None
    for i in left:
        sizes = {j: abs(hint_of(rows[i][j])) for j in columns}
        limit = PIVOT * max(sizes.values())
        across = sum(not _is_zero(rows[i][j]) for j in columns)
        for j in columns:
            if sizes[j] < limit or sizes[j] == 0.0:
                continue
            down = sum(not _is_zero(rows[k][j]) for k in left)
            found = ((across - 1) * (down - 1), -sizes[j], i, j)
            if best is None or found < best:
                best = found
    if best is None:
        raise ZeroDivisionError("the matrix is singular")
    return best[2], best[3]
