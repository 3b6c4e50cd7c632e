/** Time and energy of the way still to go, live while walking; of the edited way before it. */
import { Reading } from "../components/Reading";
import { UNKNOWN, fixed } from "../components/format";
import { useLatest } from "../console/useLatest";
import { basis, estimate, spokenDuration } from "./outlook";

const KEY = "state/outlook";

/** `edited` is the length of the edited way, m; null when there is none. */
export function MissionOutlook({ edited, unsent }: { edited: number | null; unsent: boolean }) {
  const outlook = useLatest(KEY);
  const mission = useLatest("state/mission");
  const walked = !unsent && (mission?.phase === "active" || mission?.phase === "paused");
  const metres = walked ? mission?.distance_left : edited;
  if (typeof metres !== "number") return null;
  const { seconds, joules } = estimate(metres, outlook);
  return (
    <>
      <div className="readings">
        <Reading
          label={walked ? "Time left" : "Time"}
          source={KEY}
          value={Number.isFinite(seconds) ? spokenDuration(seconds) : UNKNOWN}
          unit="min"
        />
        <Reading label={walked ? "Energy left" : "Energy"} source={KEY} value={fixed(joules / 1000, 1)} unit="kJ" />
      </div>
      <p className="hint">{basis(outlook)}</p>
    </>
  );
}
