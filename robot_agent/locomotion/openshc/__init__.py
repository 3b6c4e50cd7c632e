"""OpenSHC 0.5.11 reproduced tick for tick, defects of its gait and solver included, to compare against."""

from robot_agent.locomotion.openshc.warm_up import warm_up

__all__ = ["warm_up"]
