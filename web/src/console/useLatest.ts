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
  const { level, age } = freshness(state.values[key]?.received, state.now, limitsOf(key), state.connection === "open");
  return { level, age: level === "live" ? 0 : age < 1 ? Math.round(age * 10) / 10 : Math.round(age) };
}

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
