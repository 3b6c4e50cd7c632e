import { expect, test } from "vitest";
import { alertsOf } from "../src/status/advice";

const CALM = { reasons: [], temperature: 40, battery: 0.8, pace: 1, odometry: "good" };

function adviceFor(reason: string): string {
  return alertsOf({ ...CALM, reasons: [reason] })[0]!.advice;
}

test("nothing is said while all is well", () => {
  expect(alertsOf(CALM)).toEqual([]);
});

test.each([
  ["vision is silent: the robot does not know where it is", /by hand, or sit/],
  ["no operator is in control", /Take control/],
  ["the operator has been silent for 1.2 s", /Take control/],
  ["tilted by 24 degrees", /Drive back/],
  ["tilted by 70 degrees: fallen over", /Set it on its belly/],
  ["joint AR_femur is stuck", /Free the leg/],
  ["servo AR_yaw has stopped: nothing was heard from the computer", /goes on softly/],
  ["a servo is at 76 degrees Celsius", /rest/],
  ["a servo has not answered for 0.2 s", /cables and power/],
  ["servo AR_yaw has shut down: overload", /cables and power/],
  ["bus left is down", /cables and power/],
  ["the servos' supply has failed: none knows its settings", /cables and power/],
  ["the IMU has been silent for 0.3 s", /IMU/],
  ["the attitude is unknown", /IMU/],
  ["the power monitor has been silent for 2 s", /battery yourself/],
  ["the battery is at 22.9 V", /Bring it home/],
  ["reading all servos takes longer than a tick leaves", /doctor/],
  ["stopped by the operator", /Release the stop/],
  ["held for 60 s", /sits down by itself/],
  ["the direction of gravity is missing", /IMU/],
])("what the robot says, %s, has advice of its own", (reason, wanted) => {
  expect(adviceFor(reason)).toMatch(wanted);
});

test("a warm servo, a low battery and a slow computer are told before the robot acts", () => {
  const alerts = alertsOf({ ...CALM, temperature: 66, battery: 0.1, pace: 0.4 });
  expect(alerts.map(({ advice }) => advice)).toEqual([
    expect.stringMatching(/rest/),
    expect.stringMatching(/Bring it home/),
    expect.stringMatching(/too slow for this world/),
  ]);
  expect(alerts.map(({ text }) => text)).toEqual([
    "a servo is at 66 °C",
    "the battery is at 10 %",
    "simulated time runs slower: 0.40 of real time",
  ]);
});
