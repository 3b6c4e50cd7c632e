/** Missions kept by the console under a name. */
import type { Waypoint } from "../protocol/messages";

export interface SavedMission {
  name: string;
  waypoints: Waypoint[];
  /** Forbidden ground that belongs to it. */
  areas: Waypoint[][];
  operator: string;
  robot: string;
  /** Unix time, s. */
  saved: number;
}

export async function listMissions(): Promise<SavedMission[]> {
  const { missions } = (await ask("GET", "/api/missions")) as { missions: SavedMission[] };
  return missions;
}

export async function saveMission(mission: Omit<SavedMission, "saved">): Promise<void> {
  const { name, ...rest } = mission;
  await ask("PUT", address(name), rest);
}

export async function deleteMission(name: string): Promise<void> {
  await ask("DELETE", address(name));
}

function address(name: string): string {
  return `/api/missions/${encodeURIComponent(name)}`;
}

/** Throws with a sentence for the operator when the console refuses or can not be reached. */
async function ask(method: string, path: string, body?: unknown): Promise<unknown> {
  let response: Response;
  try {
    const sent = { headers: { "content-type": "application/json" }, body: JSON.stringify(body) };
    response = await fetch(path, { method, ...(body === undefined ? {} : sent) });
  } catch {
    throw new Error("the console is unreachable");
  }
  const answer: unknown = await response.json().catch(() => null);
  if (response.ok) return answer;
  const { error } = (answer ?? {}) as { error?: string };
  throw new Error(error ?? `the console answered ${response.status}`);
}
