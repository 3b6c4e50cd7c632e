import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { LOGIN_NEEDED, ReconnectingSocket } from "../src/protocol/reconnectingSocket";

/** The wire's end of a WebSocket: tests open, close and read it. */
class Wire {
  static readonly OPEN = 1;
  static all: Wire[] = [];
  readyState = 0;
  sent: string[] = [];
  onopen?: () => void;
  onclose?: (event: { code: number }) => void;
  onmessage?: (event: { data: string }) => void;
  constructor(readonly url: string) {
    Wire.all.push(this);
  }
  open() {
    this.readyState = Wire.OPEN;
    this.onopen?.();
  }
  drop(code = 1006) {
    this.readyState = 3;
    this.onclose?.({ code });
  }
  close() {
    this.readyState = 3;
  }
  send(text: string) {
    this.sent.push(text);
  }
}

const last = () => Wire.all.at(-1)!;
const events = { opened: vi.fn(), received: vi.fn(), lost: vi.fn() };
let socket: ReconnectingSocket;

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("WebSocket", Wire);
  vi.clearAllMocks();
  Wire.all = [];
  socket = new ReconnectingSocket(() => "ws://console/ws", events);
  socket.connect();
});

afterEach(() => {
  socket.close();
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

it("comes back after a loss, ever more slowly, and at once again after a success", () => {
  last().drop();
  vi.advanceTimersByTime(299);
  expect(Wire.all).toHaveLength(1);
  vi.advanceTimersByTime(1);
  expect(Wire.all).toHaveLength(2);
  last().drop();
  vi.advanceTimersByTime(599);
  expect(Wire.all).toHaveLength(2);
  vi.advanceTimersByTime(1);
  last().open();
  last().drop();
  vi.advanceTimersByTime(300);
  expect(Wire.all).toHaveLength(4);
});

it("says whether a message could be handed over", () => {
  expect(socket.send({ type: "retain" })).toBe(false);
  last().open();
  expect(socket.send({ type: "retain" })).toBe(true);
  expect(last().sent).toEqual(['{"type":"retain"}']);
});

it("does not fight for its place after a login is asked for", () => {
  last().open();
  last().drop(LOGIN_NEEDED);
  vi.advanceTimersByTime(60_000);
  expect(Wire.all).toHaveLength(1);
  expect(events.lost).toHaveBeenCalledWith(LOGIN_NEEDED, true);
});

it("gives up a silent connection and ignores its late end", () => {
  const silent = last();
  silent.open();
  socket.abandon();
  vi.advanceTimersByTime(300);
  expect(Wire.all).toHaveLength(2);
  silent.drop();
  vi.advanceTimersByTime(60_000);
  expect(Wire.all).toHaveLength(2);
  expect(events.lost).toHaveBeenCalledTimes(1);
});
