"""One setting for all property tests: the same examples everywhere, and no clock that could fail a slow computer."""

from hypothesis import settings

settings.register_profile("deterministic", derandomize=True, deadline=None, database=None)
settings.load_profile("deterministic")
