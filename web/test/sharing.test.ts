import { beforeEach, expect, it } from "vitest";
import { cornerAt, finishArea, followAreas, resetAreas, startArea } from "../src/areas/areaStore";
import { sendAreas } from "../src/areas/sharing";
import { settleAnswer } from "../src/console/commands";
import { sendThrough } from "../src/console/outbox";
import { receive } from "../src/console/receive";
import { INITIAL, useConsole } from "../src/console/store";
import { useDraft } from "../src/mission/draftStore";
import type { Answer, Incoming, Outgoing } from "../src/protocol/wire";

const value = (key: string, content: unknown) =>
  ({ type: "value", robot: "a", key, kind: "", stamp_ns: 0, age_s: 0, value: content }) as unknown as Incoming;

let asked: Extract<Outgoing, { type: "command" }>[];

/** A page at a robot that `holder` controls. */
function arrive(holder: string): void {
  const messages = [
    { type: "hello", operator: "ada", role: "operator" } as unknown as Incoming,
    { type: "robots", robots: [{ id: "a", kind: "SIM", alive: true }] } as unknown as Incoming,
    { type: "selected", robot: "a" } as Incoming,
    value("state/lease", { holder, epoch: 1, seconds_left: 2 }),
    value("state/mode", { mode: "STAND", reasons: [], allowed: ["set_areas"] }),
  ];
  useConsole.setState({ ...receive({ ...INITIAL, connection: "open", selected: "a" }, messages, 1000), now: 1000 });
}

function draw(x: number): void {
  startArea();
  for (const [dx, y] of [[0, 0], [1, 0], [1, 1]] as const) cornerAt({ x: x + dx, y });
  finishArea();
}

async function answer(accepted = true): Promise<void> {
  const { id, command } = asked.at(-1)!;
  settleAnswer({ type: "answer", id, command, accepted, reason: "", applied_value: 1 } as unknown as Answer);
  for (let k = 0; k < 5; k++) await Promise.resolve();
}

const told = () => asked.map(({ command, name }) => `${command} ${name}`);

beforeEach(() => {
  asked = [];
  sendThrough((message) => {
    if (message.type === "command") asked.push(message);
    return true;
  });
  resetAreas();
  useDraft.getState().reset();
});

it("an area binds the robot as soon as who controls it has closed, deleted or restored it", async () => {
  arrive("ada");
  draw(2);
  await Promise.resolve();
  expect(told()).toEqual(["set_areas 3"]);
  await answer();
  useDraft.getState().dispatch({ type: "undo" }); // before the robot has told its areas back
  await Promise.resolve();
  expect(told()).toEqual(["set_areas 3", "set_areas "]);
  await answer();
  useDraft.getState().dispatch({ type: "redo" });
  await Promise.resolve();
  expect(told().at(-1)).toBe("set_areas 3");
  await answer();
});

it("what another robot, or this one before it started anew, was told is sent again", async () => {
  arrive("ada");
  draw(2);
  await Promise.resolve();
  await answer();
  resetAreas();
  useDraft.getState().reset();
  draw(2);
  await Promise.resolve();
  expect(told()).toEqual(["set_areas 3", "set_areas 3"]);
  await answer();
});

it("two changes at once reach the robot in their order", async () => {
  arrive("ada");
  draw(2);
  draw(5);
  await Promise.resolve();
  expect(asked).toHaveLength(1);
  await answer();
  expect(told().at(-1)).toBe("set_areas 3 3");
  await answer();
  expect(asked.length).toBeLessThanOrEqual(2);
});

it("without control nothing is sent, until somebody in control asks for it", async () => {
  arrive("bob");
  draw(2);
  await Promise.resolve();
  expect(asked).toEqual([]);
  arrive("ada");
  const sent = sendAreas();
  await Promise.resolve();
  expect(told()).toEqual(["set_areas 3"]);
  await answer(false);
  expect(await sent).toBe(false);
});

it("what the robot tells is taken over and not sent back to it", async () => {
  arrive("ada");
  followAreas([[{ x: 0, y: 0 }, { x: 1, y: 0 }, { x: 1, y: 1 }]]);
  await Promise.resolve();
  expect(asked).toEqual([]);
  expect(await sendAreas()).toBe(true);
  expect(asked).toEqual([]);
});
