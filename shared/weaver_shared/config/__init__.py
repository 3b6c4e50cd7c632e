"""Settings of the stages, one module each: typed, with their defaults."""
