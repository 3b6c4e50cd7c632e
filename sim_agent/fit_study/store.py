"""All trials in one Parquet table, a row each: what was walked is found again after an interruption."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path

import pyarrow as pa
from pyarrow import parquet

from sim_agent.fit_study.plan import Trial
from sim_agent.fit_study.trial import TrialResult
from sim_agent.study_folder import made_folder

KEY, VERSION = b"weaver.fit_study", b"1"
PLANNED = [field.name for field in fields(Trial)]


class TrialStore:
    """Results by the name of their trial, in trials.parquet of a folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = made_folder(folder)
        self._file = folder / "trials.parquet"
        self._known = {result.trial.name: result for result in self._read()}

    def load(self, trial: Trial) -> TrialResult | None:
        found = self._known.get(trial.name)
        return found if found is not None and found.trial == trial else None

    def save(self, result: TrialResult) -> None:
        """Whole or not at all: the table is written beside the old one and takes its place."""
        self._known[result.trial.name] = result
        table = pa.Table.from_pylist([known.as_dict() for known in self._known.values()])
        unfinished = self.folder / ".trials.unfinished"
        parquet.write_table(table.replace_schema_metadata({KEY: VERSION}), unfinished, compression="zstd")
        unfinished.replace(self._file)

    def _read(self) -> list[TrialResult]:
        if not self._file.is_file():
            return []
        try:
            table = parquet.read_table(self._file)
        except (OSError, pa.ArrowInvalid):
            return []
        if (table.schema.metadata or {}).get(KEY) != VERSION:
            return []
        return [_result(row) for row in table.to_pylist()]


def _result(row: dict[str, object]) -> TrialResult:
    trial = Trial(**{name: row.pop(name) for name in PLANNED})  # type: ignore[arg-type]
    return TrialResult(trial=trial, **row)  # type: ignore[arg-type]
