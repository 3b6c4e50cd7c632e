/** What needs the operator, each with what to do; nothing is shown while all is well. */
import { useConsole } from "../console/store";
import { useKeys, useLatest } from "../console/useLatest";
import type { Health } from "../protocol/messages";
import { alertsOf } from "./advice";

export function Alerts() {
  const mode = useLatest("state/mode");
  const power = useLatest("tele/power");
  const keys = useKeys("tele/health/");
  const values = useConsole((state) => state.values);
  const healths = keys.flatMap((key) => (values[key]?.value as Health | undefined) ?? []);
  const temperatures = healths.flatMap((health) => health.max_temperature ?? []);
  const paces = healths.flatMap((health) => health.timings.flatMap((timing) => timing.real_time_factor ?? []));
  const alerts = alertsOf({
    reasons: [...(mode?.stopped === true ? ["the stop is latched"] : []), ...(mode?.reasons ?? [])],
    temperature: temperatures.length > 0 ? Math.max(...temperatures) : null,
    battery: power?.battery_fraction ?? null,
    pace: paces.length > 0 ? Math.min(...paces) : null,
    odometry: healths.find((health) => health.odometry_quality !== "")?.odometry_quality ?? "",
  });
  if (alerts.length === 0) return null;
  return (
    <ul className="alerts" aria-label="Alerts" role="list">
      {alerts.map(({ text, advice }) => (
        <li key={text}>
          <strong>{text}</strong> <span>{advice}</span>
        </li>
      ))}
    </ul>
  );
}
