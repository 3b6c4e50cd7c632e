/** Which terrain layer both views show, and what its colours mean. */
import { NativeSelect } from "@mantine/core";
import { UNKNOWN, fixed } from "../components/format";
import { send } from "../console/outbox";
import { usePreferences } from "../console/preferences";
import { useConsole } from "../console/store";
import { LAYERS, LAYER_LABELS, type LayerName } from "./tiles";

export function LayerLegend() {
  const layer = usePreferences((state) => state.layer);
  const choose = (name: LayerName) => {
    usePreferences.setState({ layer: name });
    send({ type: "layer", name });
  };
  return (
    <div className="layer-legend">
      <NativeSelect
        aria-label="Terrain layer"
        size="xs"
        value={layer}
        onChange={(event) => choose(event.currentTarget.value as LayerName)}
        data={LAYERS.map((name) => ({ value: name, label: LAYER_LABELS[name] }))}
      />
      <LegendBar />
    </div>
  );
}

function LegendBar() {
  const legend = useConsole((state) => state.legend);
  const first = legend?.stops[0];
  const last = legend?.stops.at(-1);
  if (!legend || first === undefined || last === undefined) return <span className="hint">No terrain yet</span>;
  const span = last[0] - first[0] || 1;
  const colours = legend.stops.map(([value, colour]) => `${colour} ${((100 * (value - first[0])) / span).toFixed(1)}%`);
  const unit = legend.unit === "" || legend.unit === "1" ? "" : ` ${legend.unit}`;
  return (
    <div className="legend">
      <span className="number">{text(first[0])}</span>
      <span
        className="legend-bar"
        style={{ background: `linear-gradient(to right, ${colours.join(", ")})` }}
        aria-hidden
      />
      <span className="number">
        {text(last[0])}
        {unit}
      </span>
      <span className="legend-unknown" aria-hidden />
      <span>unknown</span>
    </div>
  );
}

function text(value: number): string {
  return Number.isFinite(value) ? fixed(value, Math.abs(value) >= 10 || Number.isInteger(value) ? 0 : 2) : UNKNOWN;
}
