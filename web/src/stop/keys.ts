/** Which keys stop the robot: Escape anywhere, Space outside text fields. Also those the 3-D view forwards. */

export interface StopKey {
  key: string;
  code: string;
  repeat: boolean;
  ctrlKey: boolean;
  altKey: boolean;
  metaKey: boolean;
}

const TEXT_INPUTS = new Set(["text", "search", "email", "password", "tel", "url", "number", "date", "time"]);

/** `inTextField`: the key goes into a field where a space is a character. */
export function isStopKey(event: StopKey, inTextField: boolean): boolean {
  if (event.ctrlKey || event.altKey || event.metaKey) return false;
  if (event.key === "Escape") return true;
  return event.code === "Space" && !inTextField;
}

export function isTextField(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.isContentEditable || target instanceof HTMLTextAreaElement) return true;
  return target instanceof HTMLInputElement && TEXT_INPUTS.has(target.type);
}
