/** What a message of the console sets going beside the store: terrain, history, draft, answers and notices. */
import { cornerAt, followAreas, resetAreas } from "../areas/areaStore";
import { type TileMessage } from "../map/tiles";
import { useDraft } from "../mission/draftStore";
import type { AdaptationReport, ForbiddenAreas, GaitState, MissionState, RobotState } from "../protocol/messages";
import type { Incoming } from "../protocol/wire";
import { publishWatched } from "../scene/watching";
import { settleAnswer } from "./commands";
import { rememberOperator } from "./identity";
import { history, terrain } from "./live";
import { measureAt, publishMeasure } from "../measure/measureStore";
import { notify } from "./notices";
import { selectRobot, send } from "./outbox";
import { usePreferences } from "./preferences";
import { matches } from "./receive";
import { latest, useConsole } from "./store";

/** The robot whose terrain, history and draft are kept here. */
let shown: string | null = null;

export function react(message: Incoming, now: number): void {
  switch (message.type) {
    case "hello":
      rememberOperator(message.operator);
      restore();
      break;
    case "robots":
      chooseOnlyRobot();
      break;
    case "selected":
      changeRobot(message.robot);
      deliverPendingStop();
      break;
    case "value":
      if (message.robot === useConsole.getState().selected)
        keep(message.key, message.value, now - 1000 * message.age_s);
      break;
    case "forget":
      terrain.forget((key) => matches(key, message.keys));
      if (message.keys.some((key) => key.startsWith("tele/state") || key === "*")) history.clear();
      break;
    case "answer":
      settleAnswer(message);
      break;
    case "picked":
      if (!measureAt(message) && !cornerAt(message))
        useDraft.getState().dispatch({ type: "add", waypoint: { x: message.x, y: message.y } });
      break;
    case "missed":
      notify("info", `Nothing was placed: ${message.reason}.`);
      break;
    case "dragged":
      useDraft.getState().drag(message.index, { x: message.x, y: message.y }, message.done);
      break;
    case "asked":
      notify("warning", `${message.asker} asks for control. Hand over or decline at the top of the page.`);
      break;
    case "request":
      if (message.state !== "over") notify(message.state === "granted" ? "info" : "warning", `${sentence(message.text)}.`);
      break;
    case "error":
      notify("error", message.reason);
      break;
  }
}

function sentence(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

function keep(key: string, value: unknown, received: number): void {
  if (key.startsWith("tele/map/tile/")) terrain.put(key, value as TileMessage, received);
  else if (key === "tele/state") history.addState(value as RobotState, costOfTransport());
  else if (key === "tele/gait") history.addGait(value as GaitState);
  else if (key === "state/areas") followAreas((value as ForbiddenAreas).areas);
  else if (key === "state/mission") useDraft.getState().follow((value as MissionState).waypoints);
  else if (key === "tele/adaptation") history.addAdaptation(value as AdaptationReport);
}

function costOfTransport(): number | null {
  return latest(useConsole.getState(), "tele/power")?.value.cost_of_transport ?? null;
}

/** The same robot again, after a reconnection, keeps its draft and history; its terrain is sent anew. */
function changeRobot(robot: string | null): void {
  terrain.forget(() => true);
  if (robot === shown) return;
  shown = robot;
  history.clear();
  useDraft.getState().reset();
  resetAreas();
}

/** A new connection knows nothing of what this page showed before. */
function restore(): void {
  const { selected, hello } = useConsole.getState();
  const { layer, view } = usePreferences.getState();
  if (selected !== null) selectRobot(selected);
  if (hello?.layers.includes(layer)) send({ type: "layer", name: layer });
  send({ type: "view", ...view });
  publishWatched();
  useDraft.getState().publish();
  publishMeasure();
}

/** With one robot there is nothing to choose. */
function chooseOnlyRobot(): void {
  const { robots, selected } = useConsole.getState();
  const alive = robots.filter((robot) => robot.alive);
  if (selected === null && alive.length === 1) selectRobot(alive[0]!.id);
}

function deliverPendingStop(): void {
  const { stopPending, selected } = useConsole.getState();
  if (!stopPending || selected === null) return;
  useConsole.setState({ stopPending: false });
  send({ type: "command", id: "pending-stop", command: "stop" });
  notify("warning", "The stop you asked for while the console was unreachable has been sent now.");
}
