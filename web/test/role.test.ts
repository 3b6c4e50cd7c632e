import { beforeEach, expect, test } from "vitest";
import { hindrance, unreachable } from "../src/console/control";
import { receive } from "../src/console/receive";
import { INITIAL, type ConsoleState } from "../src/console/store";
import type { Hello, Incoming, RobotEntry } from "../src/protocol/wire";

const HELLO: Hello = {
  type: "hello",
  page: "page-0001",
  operator: "anna",
  user: "anna",
  role: "operator",
  version: "0",
  scene: null,
  layers: [],
  layer: "elevation",
  passing_radius_m: 0.5,
  goal_radius_m: 0.1,
  schema: 1,
};
const ROBOT = { id: "weaver", alive: true } as RobotEntry;
let state: ConsoleState;

beforeEach(() => {
  const messages: Incoming[] = [HELLO, { type: "robots", robots: [ROBOT] }, { type: "selected", robot: "weaver" }];
  state = receive({ ...INITIAL, connection: "open" }, messages, 0);
});

test("an operator may ask for control", () => {
  expect(unreachable(state)).toBeNull();
  expect(hindrance(state, "stand")).toBe("take control first");
});

test("a viewer is told why nothing but stopping is possible", () => {
  const viewer = receive(state, [{ type: "role", role: "viewer" }], 1);
  expect(unreachable(viewer)).toContain("viewer");
  expect(hindrance(viewer, "stand")).toContain("viewer");
});
