"""A Parquet file a walk: what was finished is found again after an interruption."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pyarrow as pa
from pyarrow import parquet

from sim_agent.study_folder import made_folder
from sim_agent.testbed_study.plan import PlannedWalk
from sim_agent.testbed_study.walk import COLUMNS, WalkRecord, outcome_of

VERSION = 2
KEY = b"weaver.testbed_study"


class RecordStore:
    """Records in a folder, by the name of their walk."""

    def __init__(self, folder: Path) -> None:
        self.folder = made_folder(folder)

    def save(self, record: WalkRecord) -> None:
        """Whole or not at all: a file that an interruption leaves half written does not count."""
        head = json.dumps({"version": VERSION, **outcome_of(record)})
        table = pa.table(record.rows).replace_schema_metadata({KEY: head.encode()})
        unfinished = self.folder / f".{record.plan.name}.unfinished"
        parquet.write_table(table, unfinished, compression="zstd")
        unfinished.replace(self._path(record.plan))

    def load(self, plan: PlannedWalk) -> WalkRecord | None:
        """The record of exactly this walk; None if there is none, or one of another plan or version by its name."""
        path = self._path(plan)
        if not path.is_file():
            return None
        try:
            table = parquet.read_table(path)
        except (OSError, pa.ArrowInvalid):
            return None
        head = json.loads((table.schema.metadata or {}).get(KEY, b"{}"))
        expected = json.loads(json.dumps({"version": VERSION, **plan.as_dict()}))
        if any(head.get(name) != value for name, value in expected.items()) or set(COLUMNS) - set(table.column_names):
            return None
        rows = {name: np.asarray(table.column(name), dtype=np.float64) for name in COLUMNS}
        return WalkRecord(
            plan=plan,
            outcome=str(head["outcome"]),
            duration=float(head["duration"]),
            drift_percent=float(head["drift_percent"]),
            rows=rows,
        )

    def _path(self, plan: PlannedWalk) -> Path:
        return self.folder / f"{plan.name}.parquet"
