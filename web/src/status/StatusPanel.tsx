/** How well the robot's own processes keep up. */
import { Panel } from "../components/Panel";
import { Reading } from "../components/Reading";
import { UNKNOWN, fixed, milliseconds, percent } from "../components/format";
import { useFreshness, useKeys, useLatest } from "../console/useLatest";
import type { LoopTiming } from "../protocol/messages";
import { Alerts } from "./Alerts";
import { type HealthKey, OdometryReadings } from "./OdometryReadings";

const POWER = "tele/power";

export function StatusPanel() {
  const keys = useKeys("tele/health/") as HealthKey[];
  return (
    <Panel title="Health" className="health">
      <Alerts />
      <OdometryReadings keys={keys} />
      {keys.length === 0 ? <p className="empty">No process has reported yet.</p> : <LoopTable keys={keys} />}
      <PowerDetails />
    </Panel>
  );
}

function LoopTable({ keys }: { keys: readonly HealthKey[] }) {
  return (
    <table className="loops">
      <thead>
        <tr>
          <th scope="col">Loop</th>
          <th scope="col">Rate, Hz</th>
          <th scope="col">p99 late, ms</th>
          <th scope="col">Overruns</th>
          <th scope="col">Real time, ×</th>
          <th scope="col">CPU, %</th>
        </tr>
      </thead>
      <tbody>
        {keys.map((key) => (
          <ProcessRows key={key} source={key} />
        ))}
      </tbody>
    </table>
  );
}

function ProcessRows({ source }: { source: HealthKey }) {
  const health = useLatest(source);
  const { level } = useFreshness(source);
  return health?.timings.map((timing) => <LoopRow key={timing.name} timing={timing} level={level} />);
}

function LoopRow({ timing, level }: { timing: LoopTiming; level: string }) {
  const lost = level === "lost";
  const show = (text: string) => (lost ? UNKNOWN : text);
  return (
    <tr data-freshness={level}>
      <th scope="row">
        {timing.name}
        {level !== "live" && ` (${level})`}
      </th>
      <td>{show(fixed(timing.rate, 1))}</td>
      <td>{show(milliseconds(timing.period_error_p99, 1))}</td>
      <td>{show(String(timing.overruns))}</td>
      <td>{show(fixed(timing.real_time_factor, 2))}</td>
      <td>{show(percent(timing.cpu_fraction))}</td>
    </tr>
  );
}

function PowerDetails() {
  const power = useLatest(POWER);
  const current = (power?.supply_power ?? NaN) / (power?.battery_voltage ?? NaN);
  return (
    <div className="readings">
      <Reading label="Supply current" source={POWER} value={fixed(current, 1)} unit="A" />
      <Reading label="Motor power" source={POWER} value={fixed(power?.motor_power, 0)} unit="W" />
      <Reading label="Energy used" source={POWER} value={fixed((power?.energy ?? NaN) / 1000, 1)} unit="kJ" />
      <Reading label="Cost of transport" source={POWER} value={fixed(power?.cost_of_transport, 2)} />
    </div>
  );
}
