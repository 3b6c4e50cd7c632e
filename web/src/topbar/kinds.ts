/** What the operator is dealing with, in colour and in words. */
import type { RobotKind } from "../protocol/messages";

export const KIND_CLASS: Record<RobotKind, string> = {
  SIM: "kind-sim",
  "EMULATED BUS": "kind-emulated",
  REAL: "kind-real",
  REPLAY: "kind-replay",
};

export function bannerText(kind: RobotKind, world: string): string {
  switch (kind) {
    case "SIM":
      return `Simulated robot${world === "" ? "" : ` in the world “${world}”`}: nothing real moves.`;
    case "EMULATED BUS":
      return "Emulated servo bus: the robot's own software, no real motors.";
    case "REPLAY":
      return "REPLAY of a recording: nothing here happens now, and nothing can be commanded.";
    case "REAL":
      return "Real robot: motors move. Keep people and cables clear of the legs.";
  }
}
