/** One WebSocket that comes back by itself: 0.3 s after a loss, doubling up to 2 s, for ever. */
import { type Incoming, type Outgoing, parseFrame } from "./wire";

const FIRST_DELAY = 300; // ms
const LONGEST_DELAY = 2000; // ms

/** Close codes that the page must not answer by reconnecting at once. */
export const REPLACED = 4000;
export const LOGIN_NEEDED = 4001;

/** As a browser reports a connection that ended without a word. */
const SILENT = 1006;

export interface SocketEvents {
  opened(): void;
  received(messages: Incoming[]): void;
  /** `final`: it will not be tried again by itself. */
  lost(code: number, final: boolean): void;
}

export function retryDelay(attempt: number): number {
  return Math.min(FIRST_DELAY * 2 ** attempt, LONGEST_DELAY);
}

export class ReconnectingSocket {
  private socket: WebSocket | null = null;
  private attempt = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private closed = false;

  constructor(
    private readonly address: () => string,
    private readonly events: SocketEvents,
  ) {}

  connect(): void {
    clearTimeout(this.timer);
    this.closed = false;
    const socket = new WebSocket(this.address());
    this.socket = socket;
    socket.onopen = () => {
      this.attempt = 0;
      this.events.opened();
    };
    socket.onmessage = (event) => {
      if (typeof event.data === "string") this.events.received(parseFrame(event.data));
    };
    socket.onclose = (event) => {
      if (this.socket === socket) this.retry(event.code);
    };
  }

  /** False when the message could not be handed to an open connection. */
  send(message: Outgoing): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }

  /** Gives up a connection that has gone silent, and tries anew. */
  abandon(): void {
    const socket = this.socket;
    if (socket === null) return;
    socket.close();
    this.retry(SILENT);
  }

  close(): void {
    this.closed = true;
    clearTimeout(this.timer);
    const socket = this.socket;
    this.socket = null;
    socket?.close();
  }

  private retry(code: number): void {
    this.socket = null;
    if (this.closed) return;
    const final = code === REPLACED || code === LOGIN_NEEDED;
    this.events.lost(code, final);
    if (final) return;
    this.timer = setTimeout(() => this.connect(), retryDelay(this.attempt++));
  }
}
