"""Cameras that are not there, on GigE Vision: any client finds, sets up and reads them as it does real ones."""

from sim_agent.gige.camera import GigeCamera

__all__ = ["GigeCamera"]
