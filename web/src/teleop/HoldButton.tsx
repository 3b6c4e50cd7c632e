/** The dead-man: works only while it is held down, by finger, mouse or Enter. */
import { type KeyboardEvent, useState } from "react";

export function HoldButton({ enabled, onHold }: { enabled: boolean; onHold(held: boolean): void }) {
  const [held, setHeld] = useState(false);
  const hold = (down: boolean) => {
    setHeld(down);
    onHold(down);
  };
  const onKey = (event: KeyboardEvent) => {
    if (event.key === "Enter" && !event.repeat) hold(event.type === "keydown");
  };
  return (
    <button
      type="button"
      className="hold"
      aria-pressed={held}
      disabled={!enabled}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        hold(true);
      }}
      onPointerUp={() => hold(false)}
      onPointerCancel={() => hold(false)}
      onLostPointerCapture={() => hold(false)}
      onKeyDown={onKey}
      onKeyUp={onKey}
      onBlur={() => hold(false)}
      onContextMenu={(event) => event.preventDefault()}
    >
      {held ? "Holding" : "Hold to drive"}
    </button>
  );
}
