"""What crosses a process border: frames, messages, topics, the bus, configuration and robot descriptions."""
