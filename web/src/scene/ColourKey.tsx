/** What a fixed colour scale means. */
import type { ColourScale } from "../map/colourScale";

interface ColourKeyProps {
  label: string;
  scale: ColourScale;
  ends: readonly [string, string];
}

export function ColourKey({ label, scale, ends }: ColourKeyProps) {
  const [low, high] = [scale.stops[0]![0], scale.stops.at(-1)![0]];
  const stops = scale.stops.map(
    ([value, [red, green, blue]]) =>
      `rgb(${red} ${green} ${blue}) ${((100 * (value - low)) / (high - low)).toFixed(0)}%`,
  );
  return (
    <div className="colour-key" role="none">
      <span>{label}</span>
      <span className="number">{ends[0]}</span>
      <span className="legend-bar" style={{ background: `linear-gradient(to right, ${stops.join(", ")})` }} aria-hidden />
      <span className="number">{ends[1]}</span>
    </div>
  );
}
