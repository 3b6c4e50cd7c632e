/** The page's connection to the console: one socket, what it receives into the store, what the operator asks out. */
import { LOGIN_NEEDED, REPLACED, ReconnectingSocket } from "../protocol/reconnectingSocket";
import type { Incoming } from "../protocol/wire";
import { settleAllUnanswered } from "./commands";
import { holdsControl } from "./control";
import { expectReturn, tellLossOfControl } from "./controlLoss";
import { newPageId, socketAddress } from "./identity";
import { expireNotices } from "./notices";
import { send, sendThrough } from "./outbox";
import { react } from "./reactions";
import { receive } from "./receive";
import { useConsole } from "./store";

/** ms between two updates of the panels: at least the first, and so long that they take a fifth of the time. */
const FLUSH_PERIODS = { shortest: 100, longest: 500, share: 5 };
const TICK_PERIOD = 250;
const RETAIN_PERIOD = 250;
const PING_PERIOD = 1000;
/** Pings without anything heard after which the connection is given up: a dead network says nothing.
 *  NOTE: counted, not timed, since a page that was itself busy finds the answers waiting. */
const UNANSWERED_PINGS = 5;

/** Marks when the first values of a robot were shown, for whoever measures the page. */
const USABLE = "weaver.usable";
let marked = false;

const page = newPageId();
let waiting: Incoming[] = [];
let unansweredPings = 0;
const MOST_TAKEN = 1000; // that the console lets a page tell at once
let untakenFrames = 0;
let flushTimer: ReturnType<typeof setTimeout> | undefined;
let flushPeriod = FLUSH_PERIODS.shortest;

const socket = new ReconnectingSocket(() => socketAddress(page), { opened, received, lost });

/** Begins the connection and keeps it for as long as the page is there. */
export function startSession(): void {
  sendThrough((message) => socket.send(message));
  socket.connect();
  setInterval(tick, TICK_PERIOD);
  setInterval(() => holdsControl(useConsole.getState()) && send({ type: "retain" }), RETAIN_PERIOD);
  setInterval(ping, PING_PERIOD);
}

export function reconnectNow(): void {
  socket.connect();
}

function tick(): void {
  const now = performance.now();
  useConsole.setState({ now });
  expireNotices(now);
}

function ping(): void {
  if (!send({ type: "ping", t: performance.now() })) return;
  if (++unansweredPings > UNANSWERED_PINGS) socket.abandon();
}

function opened(): void {
  unansweredPings = 0;
  untakenFrames = 0;
  useConsole.setState({ connection: "open", lostAt: null, roundTrip: null });
  send({ type: "ping", t: performance.now() });
}

function lost(code: number): void {
  flush();
  expectReturn(performance.now());
  const connection = code === REPLACED ? "replaced" : code === LOGIN_NEEDED ? "login" : "lost";
  useConsole.setState(({ lostAt }) => ({ connection, lostAt: lostAt ?? performance.now(), link: null }));
  settleAllUnanswered("The connection to the console was lost before it answered.");
}

/** Values wait for the next flush; anything else is shown at once. */
function received(messages: Incoming[]): void {
  unansweredPings = 0;
  waiting.push(...messages);
  untakenFrames++;
  if (messages.some((message) => message.type !== "value")) flush();
  else flushTimer ??= setTimeout(flush, flushPeriod);
}

function flush(): void {
  clearTimeout(flushTimer);
  flushTimer = undefined;
  const messages = waiting;
  waiting = [];
  if (messages.length > 0) {
    const began = performance.now();
    show(messages);
    afterPainting(() => {
      flushPeriod = periodOf(performance.now() - began);
      markUsable();
    });
  }
  // NOTE: told only after the work, so that a busy page is sent less rather than later.
  if (untakenFrames > 0) send({ type: "taken", frames: Math.min(untakenFrames, MOST_TAKEN) });
  untakenFrames = 0;
}

function periodOf(cost: number): number {
  const { shortest, longest, share } = FLUSH_PERIODS;
  return Math.min(longest, Math.max(shortest, share * cost));
}

function afterPainting(then: () => void): void {
  requestAnimationFrame(() => setTimeout(then, 0));
}

/** Once values have come and the page itself has been drawn: the connection is begun before that. */
function markUsable(): void {
  if (marked || document.querySelector(".page") === null || useConsole.getState().values["tele/state"] === undefined) return;
  marked = true;
  performance.mark(USABLE);
}

function show(messages: readonly Incoming[]): void {
  const now = performance.now();
  const stored = messages.filter((message) => !(message.type === "value" && message.key.startsWith("tele/map/")));
  const before = useConsole.getState();
  useConsole.setState({ ...receive(before, stored, now), now });
  tellLossOfControl(before, useConsole.getState());
  for (const message of messages) react(message, now);
}
