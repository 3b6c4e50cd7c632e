"""OpenSHC 0.5.11 reproduced tick for tick, defects of its gait and solver included, to compare against."""
