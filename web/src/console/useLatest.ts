/** The newest value of a key, with how far it can be trusted now. */
import { useShallow } from "zustand/react/shallow";
import { type Freshness, freshness, limitsOf } from "./freshness";
import { type ConsoleState, type Topics, latest, useConsole } from "./store";

export function useLatest<K extends keyof Topics>(key: K): Topics[K] | undefined {
  return useConsole((state) => latest(state, key)?.value);
}

/** Changes only when the level does, or the age as shown. */
export function useFreshness(key: string): Freshness {
  return useConsole(useShallow((state) => freshnessOf(state, key)));
}

export function freshnessOf(state: ConsoleState, key: string): Freshness {
  const source = state.values["state/replay"] === undefined ? key : "state/replay";
  const heard = freshness(state.values[source]?.received, state.now, limitsOf(source), state.connection === "open");
  const { level, age } = source === key ? heard : freshnessInReplay(state, key, heard);
  return { level, age: level === "live" ? 0 : age < 1 ? Math.round(age * 10) / 10 : Math.round(age) };
}

/** In a replay ages are counted in recorded time, so that a pause makes nothing old and a recorded gap is seen. */
function freshnessInReplay(state: ConsoleState, key: string, replay: Freshness): Freshness {
  const value = state.values[key]?.value as { stamp_ns?: number } | undefined;
  if (value === undefined || replay.level !== "live") return value === undefined ? NEVER : replay;
  const now = (latest(state, "state/replay")?.value.stamp_ns ?? 0) / 1e6; // ms
  return freshness(value.stamp_ns === undefined ? now : value.stamp_ns / 1e6, now, limitsOf(key), true);
}

const NEVER: Freshness = { level: "never", age: NaN };

/** Keys now known under a prefix, sorted: one a process or a camera. */
export function useKeys(prefix: string): string[] {
  return useConsole(
    useShallow((state) =>
      Object.keys(state.values)
        .filter((key) => key.startsWith(prefix))
        .sort(),
    ),
  );
}
