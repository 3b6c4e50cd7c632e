import { expect, test } from "vitest";
import { nameOf, nowOf, secondsOf } from "../src/calibration/motion";
import { shareSolved } from "../src/calibration/solving";
import { USUAL, faultOf, madeAt, wordsOf } from "../src/calibration/target";
import type { CalibrationMotion } from "../src/protocol/messages";

const CAMERAS = { part: "cameras", lenses: "" } as const;

test("a target is told in metres, and from where its pictures come", () => {
  expect(wordsOf(USUAL, CAMERAS, "")).toBe("aprilgrid 6 6 0.088 0.3");
  expect(wordsOf({ ...USUAL, kind: "checkerboard", columns: 9, rows: 7, size: 25 }, CAMERAS, "a.mcap")).toBe(
    "checkerboard 9 7 0.025 from a.mcap",
  );
});

test("a target that can not be is named before it is sent", () => {
  expect(faultOf(USUAL)).toBeNull();
  expect(faultOf({ ...USUAL, columns: NaN })).toContain("whole numbers");
  expect(faultOf({ ...USUAL, columns: 30, rows: 30 })).toContain("whole numbers");
  expect(faultOf({ ...USUAL, kind: "checkerboard", rows: 2 })).toContain("from 3 up");
  expect(faultOf({ ...USUAL, size: 0 })).toContain("1 to 10000 mm");
  expect(faultOf({ ...USUAL, spacing: 2 })).toContain("0.05 to 1");
  expect(faultOf({ ...USUAL, kind: "checkerboard", spacing: NaN })).toBeNull();
});

test("camera and IMU are told with the lenses to go by", () => {
  expect(wordsOf(USUAL, { part: "imu", lenses: "" }, "")).toBe("imu aprilgrid 6 6 0.088 0.3");
  expect(wordsOf(USUAL, { part: "imu", lenses: "sim-1_2026-01-02_03-04-05" }, "a.mcap")).toBe(
    "imu aprilgrid 6 6 0.088 0.3 with sim-1_2026-01-02_03-04-05 from a.mcap",
  );
  expect(wordsOf(USUAL, { part: "cameras", lenses: "left over" }, "")).toBe("aprilgrid 6 6 0.088 0.3");
});

test("a calibration is called by when it was made", () => {
  expect(madeAt("sim-1_2026-01-02_03-04-05")).toBe("2026-01-02 03:04:05");
  expect(madeAt("by-hand")).toBe("by-hand");
});

test("solving advances step by step", () => {
  const cameras = ["", "lens of the left eye", "lens of the right eye", "both eyes together"];
  expect(cameras.map((step) => shareSolved("cameras", step))).toEqual([0, 0, 1 / 3, 2 / 3]);
  expect(shareSolved("imu", "turn and delay")).toBe(0.25);
  expect(shareSolved("imu", "all together, step 1 of at most 25")).toBe(0.5);
  expect(shareSolved("imu", "all together, step 11 of at most 25")).toBeCloseTo(0.6);
  expect(shareSolved("imu", "how sure it is")).toBe(0.75);
});

test("a motion is told with what is felt of it now, and for how long it was enough", () => {
  const turn: CalibrationMotion = {
    kind: "turn",
    axis: "x",
    now: 0.618,
    least: 0.3,
    unit: "rad/s",
    seconds: 2.1,
    wanted: 4,
    met: false,
  };
  const push: CalibrationMotion = { ...turn, kind: "push", axis: "z", least: 0.5, unit: "m/s^2", seconds: 9 };
  expect([nameOf(turn), nowOf(turn), secondsOf(turn)]).toEqual([
    "Turn about x (roll)",
    "now 0.62 rad/s, 0.3 is enough",
    "2.1 of 4 s",
  ]);
  expect([nameOf(push), nowOf(push), secondsOf(push)]).toEqual([
    "Push along z (up and down)",
    "now 0.62 m/s², 0.5 is enough",
    "4.0 of 4 s",
  ]);
});
