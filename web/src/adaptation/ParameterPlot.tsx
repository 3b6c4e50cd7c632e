/** The last minute of a parameter: what was applied, and what the ground asked for (dashed). */
import { useComputedColorScheme } from "@mantine/core";
import { useEffect, useRef } from "react";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { history } from "../console/live";
import type { Parameter } from "./parameters";

const HEIGHT = 52;
const REDRAW_PERIOD = 1000; // ms
const COLOURS = {
  light: { applied: "#0b6b80", desired: "#8a4b00" },
  dark: { applied: "#5fc4da", desired: "#ffb35c" },
};

export function ParameterPlot({ parameter }: { parameter: Parameter }) {
  const box = useRef<HTMLDivElement>(null);
  const scheme = useComputedColorScheme("light");
  const { name, lower, upper } = parameter;

  useEffect(() => {
    const element = box.current;
    if (element === null) return;
    const plot = new uPlot(options(element.clientWidth, COLOURS[scheme], lower, upper), [[], [], []], element);
    const observer = new ResizeObserver(() => plot.setSize({ width: element.clientWidth, height: HEIGHT }));
    observer.observe(element);
    const redraw = () => {
      const samples = history.parameters[name];
      plot.setData([samples.map((s) => s.seconds), samples.map((s) => s.applied), samples.map((s) => s.desired)]);
    };
    redraw();
    const timer = setInterval(redraw, REDRAW_PERIOD);
    return () => {
      clearInterval(timer);
      observer.disconnect();
      plot.destroy();
    };
  }, [name, lower, upper, scheme]);

  return (
    <figure className="plot">
      <div ref={box} role="img" aria-label={`${parameter.label} over the last minute`} />
      <figcaption>
        <span className="line line-applied" aria-hidden /> current <span className="line line-desired" aria-hidden />{" "}
        desired
      </figcaption>
    </figure>
  );
}

function options(width: number, colours: (typeof COLOURS)["light"], lower: number, upper: number): uPlot.Options {
  return {
    width,
    height: HEIGHT,
    legend: { show: false },
    cursor: { show: false },
    padding: [4, 2, 4, 2],
    axes: [{ show: false }, { show: false }],
    scales: {
      x: { time: false, range: (_plot, _low, high) => [(high ?? 60) - 60, high ?? 60] },
      y: { range: [lower, upper] },
    },
    series: [
      {},
      { stroke: colours.applied, width: 2, points: { show: false } },
      { stroke: colours.desired, width: 1.5, dash: [4, 3], points: { show: false } },
    ],
  };
}
