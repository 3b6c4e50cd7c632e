/** What had happened last when the replay is where it is; the whole list, each to go to, folds out. */
import type { ReplayMark } from "../protocol/messages";
import { clockOf } from "../recording/figures";
import { lastMark } from "./timeline";

interface ReplayEventsProps {
  marks: readonly ReplayMark[];
  seconds: number;
  recording: string;
  onGo(mark: ReplayMark): void;
}

export function ReplayEvents({ marks, seconds, recording, onGo }: ReplayEventsProps) {
  const last = lastMark(marks, seconds);
  const newest = marks[last];
  return (
    <details className="replay-events">
      <summary>
        {newest === undefined ? (
          <span className="hint">
            {recording}: {marks.length === 0 ? "nothing was logged" : "nothing has happened yet"}
          </span>
        ) : (
          <span data-severity={newest.severity}>
            {clockOf(newest.seconds)} · {newest.source}: {newest.text}
          </span>
        )}
      </summary>
      <ol aria-label="Recorded events" role="list">
        {marks.map((mark, index) => (
          <li key={index} aria-current={index === last ? "step" : undefined}>
            <button type="button" className="link-button" onClick={() => onGo(mark)}>
              <span className="number">{clockOf(mark.seconds)}</span> {mark.source}: {mark.text}
            </button>
          </li>
        ))}
      </ol>
    </details>
  );
}
