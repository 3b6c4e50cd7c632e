/**
 * Areas bind the robot at once when whoever controls it changes them, so that it keeps out of them by hand too. Changed
 * without control they wait for **Send areas** or **Start mission**.
 */
import { command } from "../console/commands";
import { hindrance } from "../console/control";
import { useConsole } from "../console/store";
import { useDraft } from "../mission/draftStore";
import { type Area, sameAreas } from "./area";
import { useAreas } from "./areaStore";

/** What the robot has accepted from here, until it tells something newer than the `before` that it told last. */
let told: { areas: readonly Area[]; before: readonly Area[] } | null = null;
let sending: Promise<boolean> = Promise.resolve(true);

/** True once the robot holds the areas as they are drawn. One after the other, or an older one could arrive last. */
export function sendAreas(): Promise<boolean> {
  sending = sending.then(sendNewest);
  return sending;
}

/** After each change of the areas by hand. */
export function shareAreas(): void {
  if (hindrance(useConsole.getState(), "set_areas") === null) void sendAreas();
}

async function sendNewest(): Promise<boolean> {
  const { areas } = useDraft.getState().draft;
  const { onRobot: before } = useAreas.getState();
  // Rather once too often: what it was told it may have lost since, with a restart or by somebody else's hand.
  const undone = told?.before === before && !sameAreas(areas, told.areas);
  if (sameAreas(areas, before) && !undone) return true;
  const name = areas.map((area) => area.length).join(" ");
  const { accepted } = await command("set_areas", { name, waypoints: areas.flat() });
  if (accepted) told = { areas, before };
  return accepted;
}
