/** A parameter's polynomial, with where on it the ground puts the robot now and how sure that is. */
import { fixed } from "../components/format";
import { selectedRobot } from "../console/control";
import { useConsole } from "../console/store";
import { useFreshness, useLatest } from "../console/useLatest";
import { type Curve, drawnOver, sampled } from "./curve";
import type { Parameter } from "./parameters";

const KEY = "tele/adaptation";
const [WIDTH, HEIGHT] = [120, 52];

export function CurvePlot({ parameter }: { parameter: Parameter }) {
  const told = useConsole((state) => selectedRobot(state)?.parameters?.[parameter.name]);
  const report = useLatest(KEY);
  const { level } = useFreshness(KEY);
  if (told?.roughness === undefined || told.step_height === undefined) return null;
  const curve: Curve = { ...told, roughness: told.roughness, step_height: told.step_height };
  const over = drawnOver(curve);
  const other = (over === "roughness" ? report?.step_height : report?.roughness) ?? 0;
  const y = (value: number) => HEIGHT - 4 - ((HEIGHT - 8) * (value - curve.lower)) / (curve.upper - curve.lower);
  const line = sampled(curve, other).map(({ at, value }) => `${(at * WIDTH).toFixed(1)},${y(value).toFixed(1)}`);
  const at = report?.[over] ?? null;
  const sigma = (over === "roughness" ? report?.roughness_sigma : report?.step_height_sigma) ?? 0;
  const desired = report?.desired[parameter.name] ?? null;
  const shown = at !== null && desired !== null && level !== "lost" && level !== "never";
  const name = over === "roughness" ? "roughness" : "step height";
  return (
    <figure className="curve" data-freshness={level}>
      <svg viewBox={`0 0 ${WIDTH} ${HEIGHT}`} role="img" aria-label={spoken(parameter, name, shown ? at : null, sigma)}>
        {shown && (
          <rect
            className="curve-sigma"
            x={Math.max(at - sigma, 0) * WIDTH}
            width={Math.max(Math.min(at + sigma, 1) - Math.max(at - sigma, 0), 0) * WIDTH}
            y={0}
            height={HEIGHT}
          />
        )}
        <polyline className="curve-line" points={line.join(" ")} />
        {shown && <circle className="curve-point" cx={at * WIDTH} cy={y(desired)} r={3.5} />}
      </svg>
      <figcaption>over {name} 0 to 1</figcaption>
    </figure>
  );
}

function spoken({ label }: Parameter, name: string, at: number | null, sigma: number): string {
  const place = at === null ? "where on it is not known" : `now at ${fixed(at, 2)}, give or take ${fixed(sigma, 2)}`;
  return `${label} over ${name}: ${place}`;
}
