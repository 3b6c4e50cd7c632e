/** Which bulky values the console is asked for: only while somebody looks. */
import { send } from "../console/outbox";

export interface Watched {
  cameras: boolean;
  features: boolean;
}

let watched: Watched = { cameras: false, features: false };

export function watch(now: Watched): void {
  if (now.cameras === watched.cameras && now.features === watched.features) return;
  watched = now;
  publishWatched();
}

/** Tells a console that may not know it yet. */
export function publishWatched(): void {
  send({ type: "watch", ...watched });
}
