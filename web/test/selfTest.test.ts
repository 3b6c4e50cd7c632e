import { expect, test } from "vitest";
import type { ModeState, PowerState } from "../src/protocol/messages";
import { selfTest } from "../src/topbar/selfTest";

const power = { battery_voltage: 26.04, battery_fraction: 0.634 } as PowerState;
const mode = { reasons: ["servo BR_roll does not answer"] } as unknown as ModeState;

test("battery and what is wrong are told in words", () => {
  expect(selfTest(power, mode)).toEqual({ battery: "26.0 V, 63 %", troubles: ["servo BR_roll does not answer"] });
});

test("a silent power monitor and a silent robot are troubles, not zeros", () => {
  const none = { battery_voltage: NaN, battery_fraction: NaN } as PowerState;
  expect(selfTest(none, undefined)).toEqual({
    battery: "unknown: its power monitor is silent",
    troubles: ["the robot has not told its state"],
  });
  expect(selfTest(undefined, { ...mode, reasons: [] } as ModeState).troubles).toEqual([]);
});
