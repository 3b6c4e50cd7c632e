"""The battery behind the converters: charge, voltage under load and current."""

import numpy as np

from weaver_shared.robots.description import Power

CELL_NOMINAL = 3.7  # V
CELL_RESISTANCE = 0.006  # ohm (chosen: a fresh 5 A h pack)

# Rest voltage of a lithium polymer cell by its charge; the usual discharge curve.
_CHARGE = np.array([0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0])
_CELL_VOLTAGE = np.array([3.0, 3.5, 3.66, 3.72, 3.76, 3.79, 3.83, 3.88, 3.94, 4.01, 4.09, 4.20])


class Battery:
    """A pack that starts full. The load asks for power, so current rises as voltage falls."""

    def __init__(self, power: Power, charge: float = 1.0) -> None:
        self._power = power
        self._cells = round(power.battery_voltage / CELL_NOMINAL)
        self._resistance = self._cells * CELL_RESISTANCE
        self._charge = charge
        self.voltage = self._rest_voltage()
        self.current = 0.0

    @property
    def charge(self) -> float:
        """What is left, 0..1."""
        return self._charge

    def draw(self, motor_power: float, dt: float) -> None:
        """Feed servos (W) and electronics through the converter for dt (s); updates voltage (V) and current (A)."""
        load = (motor_power + self._power.electronics_power) / self._power.converter_efficiency
        rest = self._rest_voltage()
        # V = E - I R and V I = load: the smaller root is the one that an unloaded pack starts from.
        discriminant = max(rest * rest - 4.0 * self._resistance * load, 0.0)
        self.current = (rest - float(np.sqrt(discriminant))) / (2.0 * self._resistance)
        self.voltage = rest - self.current * self._resistance
        self._charge = max(self._charge - self.current * dt / (3600.0 * self._power.battery_capacity_ah), 0.0)

    def _rest_voltage(self) -> float:
        return self._cells * float(np.interp(self._charge, _CHARGE, _CELL_VOLTAGE))
