/** Drives the robot while the dead-man is held; anything that takes the operator's eyes or hands away lets go of it. */
import { useEffect, useRef, useState } from "react";
import { send } from "../console/outbox";
import { onSceneKey } from "../scene/sceneKeys";
import { isTextField } from "../stop/keys";
import { type GamepadReading, readGamepad } from "./gamepad";
import { type Stick, type TeleopFrame, TeleopSampler, isDrivingKey } from "./sampler";

const POLL_PERIOD = 25; // ms
const DEAD_MAN_KEYS = new Set(["ShiftLeft", "ShiftRight"]);

export interface Teleop {
  /** The last frame sent while driving, null when the robot is not driven. */
  frame: TeleopFrame | null;
  gamepad: string | null;
  hold(held: boolean): void;
  movePad(stick: Stick | null): void;
}

/** `enabled`: this page may drive now. `limit` 0..1. */
export function useTeleop(enabled: boolean, keyboard: boolean, limit: number): Teleop {
  const [frame, setFrame] = useState<TeleopFrame | null>(null);
  const [gamepad, setGamepad] = useState<string | null>(null);
  const held = useRef(false);
  const pad = useRef<Stick | null>(null);
  const keys = useRef(new Set<string>());
  const sampler = useRef(new TeleopSampler());

  useEffect(() => {
    const letGo = () => {
      held.current = false;
      pad.current = null;
      keys.current.clear();
    };
    const press = (code: string, down: boolean) => {
      if (!isDrivingKey(code) && !DEAD_MAN_KEYS.has(code)) return;
      if (down) keys.current.add(code);
      else keys.current.delete(code);
    };
    const onKey = (event: KeyboardEvent) => {
      if (!enabled || !keyboard || isTextField(event.target)) return;
      const down = event.type === "keydown";
      press(event.code, down);
      const driving = held.current || [...keys.current].some((code) => DEAD_MAN_KEYS.has(code));
      if (down && driving && isDrivingKey(event.code)) event.preventDefault();
    };
    const abort = new AbortController();
    const { signal } = abort;
    window.addEventListener("keydown", onKey, { signal, capture: true });
    window.addEventListener("keyup", onKey, { signal, capture: true });
    window.addEventListener("blur", letGo, { signal });
    document.addEventListener("visibilitychange", letGo, { signal });
    window.addEventListener("gamepaddisconnected", letGo, { signal });
    const forget = onSceneKey((key) => enabled && keyboard && press(key.code, key.event === "keydown"));
    if (!enabled) letGo();
    return () => {
      abort.abort();
      forget();
      letGo();
    };
  }, [enabled, keyboard]);

  useEffect(() => {
    const timer = setInterval(() => {
      const reading = readGamepad(navigator.getGamepads());
      setGamepad(reading?.name ?? null);
      const next = sampler.current.sample(
        inputs(reading, enabled, limit, held.current, pad.current, keys.current),
        performance.now() / 1000,
      );
      if (next === null) return;
      send({ type: "teleop", ...next });
      setFrame(next.dead_man ? next : null);
    }, POLL_PERIOD);
    return () => clearInterval(timer);
  }, [enabled, limit]);

  return {
    frame,
    gamepad,
    hold: (down) => (held.current = down && enabled),
    movePad: (stick) => (pad.current = stick),
  };
}

function inputs(
  reading: GamepadReading | null,
  enabled: boolean,
  limit: number,
  held: boolean,
  pad: Stick | null,
  keys: ReadonlySet<string>,
) {
  // NOTE: Shift alone is no wish to drive, it also inserts waypoints on the map.
  const shifted = [...keys].some((code) => DEAD_MAN_KEYS.has(code)) && [...keys].some(isDrivingKey);
  const deadMan = enabled && (held || shifted || pad !== null || reading?.deadMan === true);
  return { keys, deadMan, pad, gamepad: reading?.stick ?? null, limit };
}
