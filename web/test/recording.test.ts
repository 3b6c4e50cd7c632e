import { expect, test } from "vitest";
import { addressOf, clockOf, rerunViewerOf, sizeOf, startOf } from "../src/recording/figures";

test("a length is told in minutes and seconds, and in hours when it has some", () => {
  expect([0, 7.9, 65, 725, 3723].map(clockOf)).toEqual(["0:00", "0:07", "1:05", "12:05", "1:02:03"]);
});

test("a size is told in megabytes, and in gigabytes when it has some", () => {
  expect([0, 420_000, 87_200_000, 1_234_000_000].map(sizeOf)).toEqual(["0.0 MB", "0.4 MB", "87 MB", "1.2 GB"]);
});

test("a recording began when the robot's own clock says so", () => {
  expect(startOf("2026-01-02T03:04:05+09:00")).toBe("2026-01-02 03:04:05");
  expect(startOf("some day")).toBe("some day");
});

test("a name can not lead out of a robot's recordings", () => {
  expect(addressOf("sim-1", "../../secret")).toBe("/api/recordings/sim-1/..%2F..%2Fsecret");
});

test("Rerun's viewer is the console's own and is told where the file is", () => {
  const address = new URL(rerunViewerOf("sim-1", "a.mcap", "http://127.0.0.1:8080"), "http://127.0.0.1:8080");
  expect(address.host + address.pathname).toBe("127.0.0.1:8080/rerun/");
  expect(address.searchParams.get("url")).toBe("http://127.0.0.1:8080/api/rerun/sim-1/a.rrd");
});
