/** The events of a recording as ticks over its timeline. */
import type { ReplayMark } from "../protocol/messages";

export function MarkTicks({ marks, length }: { marks: readonly ReplayMark[]; length: number }) {
  if (length <= 0) return null;
  return (
    <svg className="replay-ticks" viewBox="0 0 100 10" preserveAspectRatio="none" aria-hidden>
      {marks.map((mark, index) => (
        <line
          // Marks never change their order.
          key={index}
          data-severity={mark.severity}
          x1={(100 * mark.seconds) / length}
          x2={(100 * mark.seconds) / length}
          y1={mark.severity === "info" ? 5 : 0}
          y2={10}
        />
      ))}
    </svg>
  );
}
