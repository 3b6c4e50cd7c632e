"""Recordings as MCAP files: everything a robot says on the bus, with its pictures, and back."""

from robot_agent.recording.reader import Recording, is_recording, open_recording
from robot_agent.recording.recorder import Recorder
from robot_agent.recording.writer import RecordingWriter

__all__ = ["Recorder", "Recording", "RecordingWriter", "is_recording", "open_recording"]
