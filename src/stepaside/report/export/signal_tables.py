"""Recordings as tables: CSV, for spreadsheets and PlotJuggler, or Parquet."""

from pathlib import Path

import numpy as np

from ...core.poses import Array
from .recording import Recording
from .signal_series import all_events, all_series


def write_csv(folder: Path, recording: Recording) -> None:
    """Write the samples and each kind of event as CSV files.

    Args:
        folder: Folder of the files.
        recording: The recording.
    """
    for name, columns in tables_of(recording).items():
        rows = np.column_stack(list(columns.values()))
        lines = [",".join(columns)]
        lines += [
            ",".join("" if value != value else repr(value) for value in row)
            for row in rows.tolist()
        ]
        text = "\n".join(lines) + "\n"
        (folder / f"{name}.csv").write_text(text, encoding="utf-8")


def write_parquet(folder: Path, recording: Recording) -> None:
    """Write the samples and each kind of event as Parquet files.

    Args:
        folder: Folder of the files.
        recording: The recording.
    """
    import polars

    for name, columns in tables_of(recording).items():
        frame = polars.DataFrame(columns).fill_nan(None)
        frame.write_parquet(folder / f"{name}.parquet")


def tables_of(recording: Recording) -> dict[str, dict[str, Array]]:
    """Return the columns of each table, by its name and theirs.

    The table ``samples`` has a row per sample. NaN stands for missing values.
    """
    columns = {"time_s": recording.run.times}
    for series in all_series(recording):
        for column, values in zip(
            series.columns, series.values.T, strict=True
        ):
            columns[f"{series.name}/{column}"] = values.astype(np.float64)
    tables = {"samples": columns}
    for table in all_events(recording):
        rows = table.rows.astype(np.float64)
        tables[table.name] = dict(zip(table.columns, rows.T, strict=True))
    return tables
