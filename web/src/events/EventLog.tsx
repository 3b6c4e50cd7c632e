/** What happened, newest first: the robots' own events, the console's, and who commanded what. */
import { memo } from "react";
import { Panel } from "../components/Panel";
import { useConsole } from "../console/store";
import type { LogEntry } from "../protocol/wire";

const SIGNS = { info: "i", warning: "!", error: "✕" } as const;

export function EventLog() {
  const events = useConsole((state) => state.events);
  return (
    <Panel
      title="Events"
      className="events"
      aside={<span className="hint">{events.length === 0 ? "" : "newest first"}</span>}
    >
      <div role="log" aria-label="Events" className="event-list" tabIndex={0}>
        {events.length === 0 && <p className="empty">Nothing has happened yet.</p>}
        {events.toReversed().map((event, k) => (
          <EventLine key={`${event.time}-${events.length - k}`} event={event} />
        ))}
      </div>
    </Panel>
  );
}

const EventLine = memo(function EventLine({ event }: { event: LogEntry }) {
  return (
    <p className="event" data-severity={event.severity}>
      <time dateTime={new Date(1000 * event.time).toISOString()}>{clock(event.time)}</time>
      <span className="event-sign" title={event.severity}>
        <span aria-hidden>{SIGNS[event.severity]}</span>
        <span className="visually-hidden">{event.severity}</span>
      </span>
      <span className="event-source">{event.robot === "" ? event.source : `${event.robot} · ${event.source}`}</span>
      <span>{event.text}</span>
    </p>
  );
});

const CLOCK = new Intl.DateTimeFormat([], { timeStyle: "medium", hour12: false });

function clock(unixSeconds: number): string {
  return CLOCK.format(1000 * unixSeconds);
}
