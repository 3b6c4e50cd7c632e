/** What each message of the console does to the store. Pure: the clock is an argument. */
import type { ControlRequest, Incoming, LogEntry } from "../protocol/wire";
import type { ConsoleState, Stamped } from "./store";

const LOG_LENGTH = 300;
/** Round trip above which values can no longer pass for new, s. */
const SLOW = 0.4;

export function receive(state: ConsoleState, messages: readonly Incoming[], now: number): ConsoleState {
  const next = { ...state };
  const values: Record<string, Stamped<unknown>> = { ...state.values };
  for (const message of messages) {
    switch (message.type) {
      case "hello":
        next.hello = message;
        next.requests = [];
        next.asking = null;
        break;
      case "role":
        if (next.hello !== null) next.hello = { ...next.hello, role: message.role };
        break;
      case "asked":
        next.requests = [...others(next.requests, message), message];
        break;
      case "asked_no_more":
        next.requests = others(next.requests, message);
        break;
      case "request":
        next.asking = message.state === "waiting" ? message : null;
        break;
      case "robots":
        next.robots = message.robots;
        break;
      case "selected":
        next.selected = message.robot;
        next.link = null;
        forget(values, ["*"]);
        break;
      case "value":
        if (message.robot === next.selected) {
          values[message.key] = { value: message.value, received: now - 1000 * (message.age_s + delay(next)) };
        }
        break;
      case "forget":
        if (message.robot === next.selected) forget(values, message.keys);
        break;
      case "link":
        next.link = message;
        next.linkReceived = now;
        break;
      case "legend":
        next.legend = message;
        break;
      case "events":
        next.events = message.events.slice(-LOG_LENGTH);
        break;
      case "event":
        next.events = [...next.events, entryOf(message)].slice(-LOG_LENGTH);
        break;
      case "pong":
        next.roundTrip = (now - message.t) / 1000;
        next.roundTripReceived = now;
        break;
      case "answer":
        if (message.round_trip_s !== null) next.commandRoundTrip = message.round_trip_s;
        break;
    }
  }
  next.values = values;
  return next;
}

/** Seconds by which values are late: none on a quick way, on a slow one the whole way there and back, to be safe. */
export function delay({ roundTrip }: Pick<ConsoleState, "roundTrip">): number {
  return roundTrip !== null && roundTrip > SLOW ? roundTrip : 0;
}

/** Whether `key` is one of `patterns`, each a key or a prefix followed by a star. */
export function matches(key: string, patterns: readonly string[]): boolean {
  return patterns.some((pattern) => (pattern.endsWith("*") ? key.startsWith(pattern.slice(0, -1)) : key === pattern));
}

function others(requests: readonly ControlRequest[], one: { robot: string; asker: string }): ControlRequest[] {
  return requests.filter((request) => request.robot !== one.robot || request.asker !== one.asker);
}

function forget(values: Record<string, unknown>, patterns: readonly string[]): void {
  for (const key of Object.keys(values)) {
    if (matches(key, patterns)) delete values[key];
  }
}

function entryOf({ robot, stamp_ns, time, severity, source, text }: LogEntry): LogEntry {
  return { robot, stamp_ns, time, severity, source, text };
}
