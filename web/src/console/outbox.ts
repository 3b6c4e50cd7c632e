/** Where messages to the console leave the page, so that whoever has something to say needs not know the connection. */
import type { Outgoing } from "../protocol/wire";

type Sender = (message: Outgoing) => boolean;
let sender: Sender = () => false;

export function sendThrough(next: Sender): void {
  sender = next;
}

/** False when there is no connection to hand the message to. */
export function send(message: Outgoing): boolean {
  return sender(message);
}

export function selectRobot(robot: string | null): void {
  send({ type: "select", robot });
}
