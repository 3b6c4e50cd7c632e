"""The paper's testbed experiment again: adaptive against fixed gait parameters, many times over (ICRA'17 IV)."""
