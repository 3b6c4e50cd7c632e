"""The walker's memory with its parts and fields as attributes, cut to the legs and joints that the robot has."""

import numpy as np

from robot_agent.locomotion.walk_state import JOINTS, LEGS

WHOLE = ("manual", "slope", "rates")
"""Fields of six values that have nothing to do with joints."""

ROWS = ("amplitude", "dh")
"""Fields of which only the first axis counts legs or joints."""


class Walk:
    """`memory` (1,) is shared: reading gives views, assigning writes."""

    def __init__(self, memory):
        self._record = memory[0]
        legs, joints = (int(self._record["model"][name]) for name in ("legs", "joints"))
        self._sizes = {LEGS: legs, JOINTS: joints, JOINTS + 1: joints + 1, LEGS * JOINTS: legs * joints}

    def __getattr__(self, part):
        return Part(self._record[part], self._sizes)


class Part:
    def __init__(self, record, sizes):
        object.__setattr__(self, "_record", record)
        object.__setattr__(self, "_sizes", sizes)

    def __getattr__(self, name):
        value = self._record[name]
        if isinstance(value, np.void):
            return Part(value, self._sizes)
        return value[self._cut(name, value)] if np.ndim(value) else value.item()

    def __setattr__(self, name, value):
        whole = self._record[name]
        if np.ndim(whole):
            whole[self._cut(name, whole)] = value
        else:
            self._record[name] = value

    def _cut(self, name, whole):
        if name in WHOLE:
            return ...
        if name in ROWS:
            return slice(self._sizes[len(whole)])
        return tuple(slice(self._sizes.get(n, n)) for n in whole.shape)
