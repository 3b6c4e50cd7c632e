"""What holds for every test: the same examples each time, and nothing beside those that keep wall-clock time."""

import pytest
from hypothesis import settings

settings.register_profile("deterministic", derandomize=True, deadline=None, database=None)
settings.load_profile("deterministic")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Whoever starts the product measures in real time, so it must have the computer for itself."""
    for item in items:
        if "start_product" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.realtime)
