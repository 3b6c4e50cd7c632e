/** Switches measuring on and tells what was measured. */
import { Button } from "@mantine/core";
import { terrain } from "../console/live";
import { useConsole } from "../console/store";
import { described, heightAt } from "./distance";
import { startMeasuring, useMeasure } from "./measureStore";

export function MeasureTool() {
  const { active, places } = useMeasure();
  useConsole(() => terrain.version); // heights come with the terrain, which may be seen later than the places are chosen
  return (
    <span className="measure">
      <Button
        size="xs"
        variant={active ? "filled" : "default"}
        aria-pressed={active}
        onClick={() => startMeasuring(!active)}
      >
        Measure
      </Button>
      {active && (
        <span role="status" aria-label="Measured" className="number">
          {words(places)}
        </span>
      )}
    </span>
  );
}

function words(places: ReturnType<typeof useMeasure.getState>["places"]): string {
  const [from, to] = places;
  if (from === undefined) return "choose the first place";
  if (to === undefined) return "choose the second place";
  return described(from, to, [heightAt(terrain, from), heightAt(terrain, to)]);
}
