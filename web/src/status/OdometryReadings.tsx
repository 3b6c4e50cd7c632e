/** How well the robot knows where it is. Reported by the process that sees; the others leave the quality empty. */
import { Reading } from "../components/Reading";
import { UNKNOWN, fixed, milliseconds } from "../components/format";
import { useConsole } from "../console/store";
import { useLatest } from "../console/useLatest";
import type { Health } from "../protocol/messages";

export type HealthKey = `tele/health/${string}`;

export function OdometryReadings({ keys }: { keys: readonly HealthKey[] }) {
  const values = useConsole((state) => state.values);
  const healths = keys.map((key) => values[key]?.value as Health | undefined);
  const seeing = keys[healths.findIndex((health) => (health?.odometry_quality ?? "") !== "")] ?? "tele/health/vision";
  const hottest = hottestOf(healths);
  const health = useLatest(seeing);
  const quality = health?.odometry_quality ?? "";
  return (
    <>
      <div className="readings readings-pairs">
        <Reading label="Odometry" source={seeing} value={quality === "" ? UNKNOWN : quality} />
        <Reading label="Features" source={seeing} value={fixed(health?.tracked_features, 0)} />
        <Reading label="Pose age" source={seeing} value={milliseconds(health?.odometry_age)} unit="ms" />
        <Reading
          label="Servo max"
          source={keys[hottest] ?? seeing}
          value={fixed(healths[hottest]?.max_temperature, 0)}
          unit="°C"
        />
      </div>
      {(health?.odometry_reason ?? "") !== "" && <p className="hint">Odometry: {health?.odometry_reason}</p>}
    </>
  );
}

/** Index of the process that reports the highest temperature, -1 when none does. */
function hottestOf(healths: readonly (Health | undefined)[]): number {
  const temperatures = healths.map((health) => health?.max_temperature ?? -Infinity);
  const highest = Math.max(...temperatures);
  return Number.isFinite(highest) ? temperatures.indexOf(highest) : -1;
}
