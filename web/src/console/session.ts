/** The page's connection to the console: one socket, what it receives into the store, what the operator asks out. */
import type { AdaptationReport, GaitState, MissionState, RobotState } from "../protocol/messages";
import { LOGIN_NEEDED, REPLACED, ReconnectingSocket } from "../protocol/reconnectingSocket";
import type { Incoming } from "../protocol/wire";
import type { TileMessage } from "../map/tiles";
import { useDraft } from "../mission/draftStore";
import { settleAnswer, settleAllUnanswered } from "./commands";
import { holdsControl } from "./control";
import { tellLossOfControl } from "./controlLoss";
import { newPageId, rememberOperator, socketAddress } from "./identity";
import { history, terrain } from "./live";
import { expireNotices, notify } from "./notices";
import { selectRobot, send, sendThrough } from "./outbox";
import { usePreferences } from "./preferences";
import { matches, receive } from "./receive";
import { useConsole } from "./store";

const FLUSH_PERIOD = 66; // ms between two updates of the panels
const TICK_PERIOD = 250;
const RETAIN_PERIOD = 500;
const PING_PERIOD = 1000;

const page = newPageId();
let waiting: Incoming[] = [];
let flushTimer: ReturnType<typeof setTimeout> | undefined;

const socket = new ReconnectingSocket(() => socketAddress(page), { opened, received, lost });
/** The robot whose terrain, history and draft are kept here. */
let shown: string | null = null;

/** Begins and keeps the connection; the returned function ends it. */
export function startSession(): () => void {
  sendThrough((message) => socket.send(message));
  socket.connect();
  const timers = [
    setInterval(tick, TICK_PERIOD),
    setInterval(() => holdsControl(useConsole.getState()) && send({ type: "retain" }), RETAIN_PERIOD),
    setInterval(() => send({ type: "ping", t: performance.now() }), PING_PERIOD),
  ];
  return () => {
    timers.forEach(clearInterval);
    socket.close();
  };
}

export function reconnectNow(): void {
  socket.connect();
}

function tick(): void {
  const now = performance.now();
  useConsole.setState({ now });
  expireNotices(now);
}

function opened(): void {
  useConsole.setState({ connection: "open", lostAt: null });
  send({ type: "ping", t: performance.now() });
}

function lost(code: number): void {
  flush();
  const connection = code === REPLACED ? "replaced" : code === LOGIN_NEEDED ? "login" : "lost";
  useConsole.setState(({ lostAt }) => ({ connection, lostAt: lostAt ?? performance.now(), link: null }));
  settleAllUnanswered("The connection to the console was lost before it answered.");
}

/** Values wait for the next flush; anything else is shown at once. */
function received(messages: Incoming[]): void {
  waiting.push(...messages);
  if (messages.some((message) => message.type !== "value")) flush();
  else flushTimer ??= setTimeout(flush, FLUSH_PERIOD);
}

function flush(): void {
  clearTimeout(flushTimer);
  flushTimer = undefined;
  const messages = waiting;
  waiting = [];
  if (messages.length === 0) return;
  const now = performance.now();
  const stored = messages.filter((message) => !(message.type === "value" && message.key.startsWith("tele/map/")));
  const before = useConsole.getState();
  useConsole.setState({ ...receive(before, stored, now), now });
  tellLossOfControl(before, useConsole.getState());
  for (const message of messages) react(message, now);
}

function react(message: Incoming, now: number): void {
  switch (message.type) {
    case "hello":
      rememberOperator(message.operator);
      restore();
      break;
    case "robots":
      chooseOnlyRobot();
      break;
    case "selected":
      changeRobot(message.robot);
      deliverPendingStop();
      break;
    case "value":
      if (message.robot === useConsole.getState().selected)
        keep(message.key, message.value, now - 1000 * message.age_s);
      break;
    case "forget":
      terrain.forget((key) => matches(key, message.keys));
      if (message.keys.some((key) => key.startsWith("tele/state") || key === "*")) history.clear();
      break;
    case "answer":
      settleAnswer(message);
      break;
    case "picked":
      useDraft.getState().dispatch({ type: "add", waypoint: { x: message.x, y: message.y } });
      break;
    case "missed":
      notify("info", `No waypoint was placed: ${message.reason}.`);
      break;
    case "dragged":
      useDraft.getState().drag(message.index, { x: message.x, y: message.y }, message.done);
      break;
    case "error":
      notify("error", message.reason);
      break;
  }
}

function keep(key: string, value: unknown, received: number): void {
  if (key.startsWith("tele/map/tile/")) terrain.put(key, value as TileMessage, received);
  else if (key === "tele/state") history.addState(value as RobotState);
  else if (key === "tele/gait") history.addGait(value as GaitState);
  else if (key === "state/mission") useDraft.getState().follow((value as MissionState).waypoints);
  else if (key === "tele/adaptation") history.addAdaptation(value as AdaptationReport);
}

/** The same robot again, after a reconnection, keeps its draft and history; its terrain is sent anew. */
function changeRobot(robot: string | null): void {
  terrain.forget(() => true);
  if (robot === shown) return;
  shown = robot;
  history.clear();
  useDraft.getState().reset();
}

/** A new connection knows nothing of what this page showed before. */
function restore(): void {
  const { selected, hello } = useConsole.getState();
  const { layer, cameras, view } = usePreferences.getState();
  if (selected !== null) selectRobot(selected);
  if (hello?.layers.includes(layer)) send({ type: "layer", name: layer });
  send({ type: "view", ...view });
  send({ type: "watch", cameras });
  useDraft.getState().publish();
}

/** With one robot there is nothing to choose. */
function chooseOnlyRobot(): void {
  const { robots, selected } = useConsole.getState();
  const alive = robots.filter((robot) => robot.alive);
  if (selected === null && alive.length === 1) selectRobot(alive[0]!.id);
}

function deliverPendingStop(): void {
  const { stopPending, selected } = useConsole.getState();
  if (!stopPending || selected === null) return;
  useConsole.setState({ stopPending: false });
  send({ type: "command", id: "pending-stop", command: "stop" });
  notify("warning", "The stop you asked for while the console was unreachable has been sent now.");
}
