"""Walks spread over processes of this computer, or over a cluster, by Dask."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from distributed import Client, LocalCluster, as_completed

from sim_agent.testbed_study.plan import PlannedWalk
from sim_agent.testbed_study.walk import WalkRecord, walk_testbed
from weaver_shared.errors import InputError

CONNECT_SECONDS = 20.0


def walk_all(
    walks: list[PlannedWalk],
    jobs: int,
    scheduler: str | None,
    walk: Callable[[PlannedWalk], WalkRecord] = walk_testbed,
) -> Iterator[WalkRecord]:
    """Records in the order they finish. `jobs` processes here, or the workers of the cluster at `scheduler`.

    Raises InputError when no scheduler answers there. A worker that dies gives its walk to another one.
    """
    if not walks:
        return
    with _client(jobs, scheduler) as client:
        futures = client.map(walk, walks, pure=False, key=[plan.name for plan in walks])
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
    with (
        LocalCluster(
            n_workers=jobs, threads_per_worker=1, processes=True, host="127.0.0.1", dashboard_address=None
        ) as cluster,
        Client(cluster) as client,
    ):
        yield client
