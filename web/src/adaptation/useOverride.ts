/** An override as the operator sees it: at once as asked, then as the robot reports it. */
import { useEffect, useState } from "react";
import { useThrottle } from "../components/useThrottle";
import { command } from "../console/commands";
import { useLatest } from "../console/useLatest";
import type { Parameter } from "./parameters";

/** How long the operator's wish is shown while the robot has not reported it yet, ms. */
const PATIENCE = 2000;
/** A slider under way is sent this often at most, ms. */
const SEND_PERIOD = 120;

export interface Override {
  active: boolean;
  /** What was last asked for; null when only the robot knows. */
  value: number | null;
  toggle(active: boolean): void;
  set(value: number): void;
}

export function useOverride({ name, lower, upper }: Parameter, seconds: number): Override {
  const report = useLatest("tele/adaptation");
  const reported = report?.overridden.includes(name) ?? false;
  const [wish, setWish] = useState<boolean | null>(null);
  const [value, setValue] = useState<number | null>(null);
  const send = useThrottle(SEND_PERIOD);

  useEffect(() => {
    if (wish === null) return;
    if (wish === reported) return setWish(null);
    const timer = setTimeout(() => setWish(null), PATIENCE);
    return () => clearTimeout(timer);
  }, [wish, reported]);

  const active = wish ?? reported;
  useEffect(() => {
    if (!active) setValue(null);
  }, [active]);

  const ask = async (wanted: number) => {
    const { accepted, applied_value } = await command("set_override", { name, value: wanted, seconds });
    if (!accepted) setWish(null);
    else if (applied_value !== null) setValue((now) => (now === wanted ? applied_value : now));
  };

  return {
    active,
    value,
    toggle(on) {
      setWish(on);
      if (!on) return void command("clear_override", { name });
      const start = Math.min(Math.max(report?.applied[name] ?? lower, lower), upper);
      setValue(start);
      void ask(start);
    },
    set(wanted) {
      setValue(wanted);
      send(() => void ask(wanted));
    },
  };
}
