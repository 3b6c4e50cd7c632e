/** Static stability margin: how far the centre of mass is inside the support polygon. */
import { Reading } from "../components/Reading";
import { fixed } from "../components/format";
import { useFreshness, useLatest } from "../console/useLatest";

const FULL = 0.2; // m, a full bar
const TIGHT = 0.03; // m

export function StabilityBar() {
  const margin = useLatest("tele/state")?.stability_margin ?? null;
  const { level } = useFreshness("tele/state");
  const shown = margin !== null && (level === "live" || level === "stale");
  const fraction = shown ? Math.min(Math.max(margin / FULL, 0), 1) : 0;
  const tone = !shown ? "quiet" : margin < 0 ? "danger" : margin < TIGHT ? "caution" : "good";
  const words = { quiet: "", danger: "outside support", caution: "tight", good: "stable" }[tone];
  return (
    <div className="stability" data-tone={tone}>
      <Reading label="Stability margin" source="tele/state" value={fixed(margin, 3)} unit="m">
        <span className="unit">{words}</span>
      </Reading>
      <div className="bar" aria-hidden>
        <div className="bar-fill" style={{ scale: `${fraction} 1` }} />
      </div>
    </div>
  );
}
