/** Short messages to the operator that go away by themselves; errors stay longest. */
import { type Notice, useConsole } from "./store";

const SHOWN_FOR = { info: 4000, warning: 8000, error: 15000 } as const; // ms
const AT_ONCE = 4;
let lastId = 0;

export function notify(severity: Notice["severity"], text: string): void {
  const notice: Notice = { id: ++lastId, severity, text, at: performance.now() };
  useConsole.setState(({ notices }) => ({
    notices: [...notices.filter((old) => old.text !== text), notice].slice(-AT_ONCE),
  }));
}

export function dismiss(id: number): void {
  useConsole.setState(({ notices }) => ({ notices: notices.filter((notice) => notice.id !== id) }));
}

export function expireNotices(now: number): void {
  const { notices } = useConsole.getState();
  const left = notices.filter((notice) => now - notice.at < SHOWN_FOR[notice.severity]);
  if (left.length !== notices.length) useConsole.setState({ notices: left });
}
