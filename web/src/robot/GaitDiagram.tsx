/** Which leg stood and which swung over the last seconds: a filled bar is stance. */
import { useComputedColorScheme } from "@mantine/core";
import { useEffect, useRef } from "react";
import type { SwingSample } from "../console/history";
import { history } from "../console/live";
import { selectedRobot } from "../console/control";
import { useConsole } from "../console/store";
import { useCanvasSize } from "../components/useCanvasSize";
import { useFreshness, useLatest } from "../console/useLatest";

const SPAN = 4; // s
const ROW = 13; // px
const LABEL = 26; // px
const COLOURS = {
  light: { stance: "#0b6b80", swing: "#dde3e8", text: "#3b4752" },
  dark: { stance: "#5fc4da", swing: "#2c3742", text: "#c5cfd8" },
};

export function GaitDiagram() {
  const canvas = useRef<HTMLCanvasElement>(null);
  const gait = useLatest("tele/gait");
  const { level } = useFreshness("tele/gait");
  const scheme = useComputedColorScheme("light");
  const legs = useConsole(selectedRobot)?.leg_names ?? [];
  const count = gait?.swing.length ?? (legs.length || 6);

  useCanvasSize(canvas, count * ROW);
  useEffect(() => {
    const frame = requestAnimationFrame(() => {
      if (canvas.current !== null) draw(canvas.current, count, legs, COLOURS[scheme]);
    });
    return () => cancelAnimationFrame(frame);
  }, [gait, count, legs, scheme]);

  return (
    <figure className="gait-diagram" data-freshness={level}>
      <canvas ref={canvas} style={{ height: count * ROW }} role="img" aria-label={spoken(gait?.swing, legs)} />
      <figcaption>
        <span className="swatch swatch-stance" aria-hidden /> stance{" "}
        <span className="swatch swatch-swing" aria-hidden /> swing, last {SPAN} s
        {level === "live" ? "" : level === "never" ? " (no data)" : ` (${level})`}
      </figcaption>
    </figure>
  );
}

function draw(
  canvas: HTMLCanvasElement,
  count: number,
  legs: readonly string[],
  colours: (typeof COLOURS)["light"],
): void {
  const context = canvas.getContext("2d");
  if (context === null) return;
  const width = canvas.width / devicePixelRatio;
  context.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
  context.clearRect(0, 0, width, count * ROW);
  context.font = "11px system-ui, sans-serif";
  context.textBaseline = "middle";
  const samples = history.swings;
  const now = samples.at(-1)?.seconds ?? 0;
  const x = (seconds: number) => LABEL + (width - LABEL) * (1 - (now - seconds) / SPAN);
  for (let leg = 0; leg < count; leg++) {
    context.fillStyle = colours.text;
    context.fillText(legs[leg] ?? String(leg + 1), 0, (leg + 0.5) * ROW);
    context.fillStyle = colours.swing;
    context.fillRect(LABEL, leg * ROW + 4.5, width - LABEL, ROW - 9);
    context.fillStyle = colours.stance;
    for (const [from, until] of stances(samples, leg, now)) {
      if (until < now - SPAN) continue;
      const left = Math.max(x(from), LABEL);
      context.fillRect(left, leg * ROW + 1.5, x(until) - left, ROW - 3);
    }
  }
}

/** Intervals in which the leg stood, in seconds of the robot's clock. */
function stances(samples: readonly SwingSample[], leg: number, now: number): [from: number, until: number][] {
  const intervals: [number, number][] = [];
  let from: number | null = null;
  for (const { seconds, swing } of samples) {
    if (swing[leg] === true && from !== null) {
      intervals.push([from, seconds]);
      from = null;
    } else if (swing[leg] === false) from ??= seconds;
  }
  if (from !== null) intervals.push([from, now]);
  return intervals;
}

function spoken(swing: readonly boolean[] | undefined, legs: readonly string[]): string {
  if (swing === undefined) return "Gait diagram, no data";
  const swinging = swing.flatMap((up, leg) => (up ? [legs[leg] ?? String(leg + 1)] : []));
  return `Gait diagram, ${swinging.length === 0 ? "all legs in stance" : `in swing: ${swinging.join(", ")}`}`;
}
