/** Solving when enough is there, and how far it has come. */
import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { command } from "../console/commands";
import { useConsole } from "../console/store";
import type { CalibrationState } from "../protocol/messages";
import { shareSolved } from "./solving";

interface SolveRowProps {
  state: CalibrationState;
  /** What is still too little to solve at all; null when nothing is. */
  lack: string | null;
  /** The lens model, where there is one to choose. */
  model?: string;
  children?: ReactNode;
}

export function SolveRow({ state, lack, model = "", children }: SolveRowProps) {
  const connected = useConsole((page) => page.connection === "open");
  if (state.phase === "solving") {
    return (
      <label className="solving">
        Solving: {state.step}
        <progress max={1} value={shareSolved(state.part, state.step)} />
      </label>
    );
  }
  return (
    <>
      <div className="button-row">
        {children}
        <Button
          className="grow"
          disabled={!connected || state.phase === "starting" || lack !== null}
          onClick={() => void command("solve_calibration", model === "" ? {} : { name: model })}
        >
          Solve and save
        </Button>
      </div>
      {lack !== null && <p className="hint">{lack}</p>}
    </>
  );
}
