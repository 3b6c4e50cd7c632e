"""Messages as JSON for the page."""

import base64
import json

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from wire_robot import ground_tile

from weaver_console.plain import plain, to_json
from weaver_shared.messages import GaitState, ModeState, PowerState, SafetyAction, TruthState


def _read(message):
    return json.loads(to_json(plain(message)))


def test_what_is_not_a_number_travels_as_null():
    power = PowerState(
        stamp_ns=1,
        battery_voltage=25.9,
        battery_fraction=float("nan"),
        supply_power=float("inf"),
        motor_power=-float("inf"),
        energy=0.0,
        cost_of_transport=float("nan"),
    )
    read = _read(power)
    assert read["battery_voltage"] == 25.9
    assert [read[name] for name in ("battery_fraction", "supply_power", "motor_power", "cost_of_transport")] == [
        None
    ] * 4


def test_arrays_become_lists_and_not_a_number_within_them_null():
    truth = TruthState(
        stamp_ns=2,
        position_in_world=np.array([1.0, np.nan, np.inf]),
        wxyz=np.array([1.0, 0.0, 0.0, 0.0]),
        velocity_in_world=np.zeros(3),
    )
    assert _read(truth)["position_in_world"] == [1.0, None, None]


def test_names_of_enumerations_and_booleans_keep_their_meaning():
    mode = ModeState(
        stamp_ns=3,
        mode="HOLD",
        action=SafetyAction.HOLD,
        reasons=("tilted",),
        stopped=True,
        stop_level="cut",
        allowed=(),
    )
    read = _read(mode)
    assert (read["action"], read["reasons"], read["stopped"]) == ("hold", ["tilted"], True)
    gait = GaitState(
        stamp_ns=4,
        gait="tripod",
        phase=np.zeros(2),
        swing=np.array([True, False]),
        parameters_frequency=1.0,
        parameters_height=0.05,
        parameters_stiffness=2500.0,
    )
    assert _read(gait)["swing"] == [True, False]


def test_tiles_travel_as_raw_little_endian_layers():
    tile = ground_tile(1, -2)
    read = _read(tile)
    assert (read["i"], read["j"], read["size"], read["cell"]) == (1, -2, 32, 0.02)
    elevation = np.frombuffer(base64.b64decode(read["elevation_mm"]), dtype="<i2").reshape(32, 32)
    assert np.array_equal(elevation, tile.elevation_mm)
    assert np.array_equal(np.frombuffer(base64.b64decode(read["roughness"]), dtype=np.uint8), tile.roughness.ravel())


@given(st.floats(allow_nan=False, allow_infinity=False, min_value=-1e6, max_value=1e6))
def test_numbers_keep_ten_micrometres(value):
    truth = TruthState(stamp_ns=0, position_in_world=np.full(3, value), wxyz=np.ones(4), velocity_in_world=np.zeros(3))
    assert abs(_read(truth)["position_in_world"][0] - value) <= 0.51e-5
