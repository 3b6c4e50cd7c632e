/** How well the robot's own processes keep up. */
import { Panel } from "../components/Panel";
import { Reading } from "../components/Reading";
import { UNKNOWN, fixed, milliseconds, percent } from "../components/format";
import { useConsole } from "../console/store";
import { useFreshness, useKeys, useLatest } from "../console/useLatest";
import type { Health, LoopTiming } from "../protocol/messages";

type HealthKey = `tele/health/${string}`;
const POWER = "tele/power";

export function StatusPanel() {
  const keys = useKeys("tele/health/") as HealthKey[];
  return (
    <Panel title="Health" className="health">
      <Odometry keys={keys} />
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

/** Odometry is reported by the process that sees; the others leave its quality empty. */
function Odometry({ keys }: { keys: readonly HealthKey[] }) {
  const values = useConsole((state) => state.values);
  const source = keys.find((key) => reports(values[key]?.value)) ?? "tele/health/vision";
  const health = useLatest(source);
  const quality = health?.odometry_quality ?? "";
  return (
    <div className="readings readings-pairs">
      <Reading label="Odometry" source={source} value={quality === "" ? UNKNOWN : quality}>
        {health !== undefined && health.odometry_reason !== "" && <span className="hint">{health.odometry_reason}</span>}
      </Reading>
      <Reading label="Tracked features" source={source} value={fixed(health?.tracked_features, 0)} />
      <Reading label="Odometry age" source={source} value={milliseconds(health?.odometry_age)} unit="ms" />
      <Reading label="Hottest servo" source={keys.find((key) => hot(values[key]?.value)) ?? source} value={fixed(hottest(keys.map((key) => values[key]?.value)), 0)} unit="°C" />
    </div>
  );
}

function PowerDetails() {
  const power = useLatest(POWER);
  return (
    <div className="readings readings-pairs">
      <Reading label="Motor power" source={POWER} value={fixed(power?.motor_power, 0)} unit="W" />
      <Reading label="Cost of transport" source={POWER} value={fixed(power?.cost_of_transport, 2)} />
    </div>
  );
}

function reports(health: unknown): boolean {
  return ((health as Health | undefined)?.odometry_quality ?? "") !== "";
}

function hot(health: unknown): boolean {
  return Number.isFinite((health as Health | undefined)?.max_temperature ?? NaN);
}

function hottest(healths: readonly unknown[]): number | null {
  const known = healths.flatMap((health) => (hot(health) ? [(health as Health).max_temperature as number] : []));
  return known.length === 0 ? null : Math.max(...known);
}
