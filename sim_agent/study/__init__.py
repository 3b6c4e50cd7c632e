"""Studies: many walks of simulated robots, each in a process of its own, and what is learnt from them."""
