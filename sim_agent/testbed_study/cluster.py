"""Walks spread over processes of this computer, or over a cluster, by Dask."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Protocol, TypeVar

from distributed import Client, LocalCluster, as_completed

from weaver_shared.errors import InputError

CONNECT_SECONDS = 20.0
CLOSE_SECONDS = 30.0


class Planned(Protocol):
    @property
    def name(self) -> str: ...


Plan = TypeVar("Plan", bound=Planned)
Record = TypeVar("Record")


def walk_all(
    walks: Sequence[Plan], walk: Callable[[Plan], Record], jobs: int, scheduler: str | None
) -> Iterator[Record]:
    """Records in the order they finish. `jobs` processes here, or the workers of the cluster at `scheduler`.

    Raises InputError when no scheduler answers there. A worker that dies gives its walk to another one.
    """
    if not walks:
        return
    with _client(jobs, scheduler) as client:
        futures = client.map(walk, list(walks), pure=False, key=[plan.name for plan in walks])
        for future in as_completed(futures):
            yield future.result()


@contextmanager
def _client(jobs: int, scheduler: str | None) -> Iterator[Client]:
    if scheduler is not None:
        try:
            with Client(scheduler, timeout=CONNECT_SECONDS) as client:
                yield client
        except (OSError, TimeoutError, ValueError) as error:
            raise InputError(f"no Dask scheduler answers at {scheduler}: {error}") from error
        return
    cluster = LocalCluster(
        n_workers=jobs, threads_per_worker=1, processes=True, host="127.0.0.1", dashboard_address="127.0.0.1:0"
    )
    try:
        with Client(cluster) as client:
            yield client
    finally:
        # All records have come by now: workers of a busy machine that are slow to end are no failure.
        with suppress(TimeoutError):
            cluster.close(timeout=CLOSE_SECONDS)
