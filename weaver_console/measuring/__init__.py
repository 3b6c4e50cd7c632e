"""Measurements of the console as a process: robots that only talk, pages that only listen, and what that costs."""
