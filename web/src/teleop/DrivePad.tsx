/** A stick for finger or mouse: up is ahead, sideways turns. Touching it is the dead-man. */
import { type PointerEvent, useRef } from "react";
import { fixed } from "../components/format";
import type { Stick } from "./sampler";

interface DrivePadProps {
  enabled: boolean;
  stick: Stick | null;
  onMove(stick: Stick | null): void;
}

export function DrivePad({ enabled, stick, onMove }: DrivePadProps) {
  const touched = useRef(false);
  const move = (event: PointerEvent<HTMLDivElement>) => {
    if (!touched.current || !enabled) return;
    const box = event.currentTarget.getBoundingClientRect();
    const across = (2 * (event.clientX - box.left)) / box.width - 1;
    const up = 1 - (2 * (event.clientY - box.top)) / box.height;
    onMove({ forward: clamp(up), left: 0, turn: clamp(-across) });
  };
  const release = () => {
    touched.current = false;
    onMove(null);
  };
  const { forward, left, turn } = stick ?? { forward: 0, left: 0, turn: 0 };
  return (
    <div
      className="pad"
      role="img"
      aria-label={`Drive pad: ahead ${fixed(100 * forward, 0)} %, left ${fixed(100 * left, 0)} %, turn ${fixed(100 * turn, 0)} %`}
      data-enabled={enabled}
      onPointerDown={(event) => {
        if (!enabled) return;
        touched.current = true;
        event.currentTarget.setPointerCapture(event.pointerId);
        move(event);
      }}
      onPointerMove={move}
      onPointerUp={release}
      onPointerCancel={release}
      onLostPointerCapture={release}
    >
      <span className="pad-knob" style={{ left: `${50 - 38 * clamp(turn + left)}%`, top: `${50 - 38 * forward}%` }} />
    </div>
  );
}

function clamp(value: number): number {
  return Math.min(Math.max(value, -1), 1);
}
