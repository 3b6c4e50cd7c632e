/** Lengths and sizes of recordings as people read them. */

/** "0:07", "12:05", "1:02:03". */
export function clockOf(seconds: number): string {
  const whole = Math.max(0, Math.floor(seconds));
  const [hours, minutes, rest] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60, whole % 60];
  const tail = `${String(minutes).padStart(hours > 0 ? 2 : 1, "0")}:${String(rest).padStart(2, "0")}`;
  return hours > 0 ? `${hours}:${tail}` : tail;
}

/** "0.4 MB", "87 MB", "1.2 GB". */
export function sizeOf(bytes: number): string {
  if (bytes >= 1e9) return `${(bytes / 1e9).toFixed(1)} GB`;
  const megabytes = bytes / 1e6;
  return `${megabytes.toFixed(megabytes < 10 ? 1 : 0)} MB`;
}

/** The day and time of an ISO 8601 text as the robot's clock had them; the text itself if it is none. */
export function startOf(iso: string): string {
  const match = /^(\d{4}-\d{2}-\d{2})T(\d{2}:\d{2}:\d{2})/.exec(iso);
  return match === null ? iso : `${match[1]} ${match[2]}`;
}

/** Where the recording is had as a Rerun file. */
export function rerunFileOf(robot: string, name: string): string {
  return `/api/rerun/${encodeURIComponent(robot)}/${encodeURIComponent(name.replace(/\.mcap$/, ".rrd"))}`;
}

/** Rerun's own viewer, served by the console, with the recording in it. */
export function rerunViewerOf(robot: string, name: string, origin: string): string {
  const query = new URLSearchParams({ url: `${origin}${rerunFileOf(robot, name)}`, hide_welcome_screen: "true" });
  return `/rerun/?${query.toString()}`;
}

/** Where a recording is downloaded from. */
export function addressOf(robot: string, name: string): string {
  return `/api/recordings/${encodeURIComponent(robot)}/${encodeURIComponent(name)}`;
}
