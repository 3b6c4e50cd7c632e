/** Recordings that are there, newest first, each with its length and size to download. */
import { useState } from "react";
import type { RecordingEntry } from "../protocol/messages";
import { startReplay } from "../replay/commands";
import { addressOf, clockOf, rerunFileOf, rerunViewerOf, sizeOf, startOf } from "./figures";

const SHOWN_AT_FIRST = 4;

export function RecordingList({ robot, entries }: { robot: string; entries: readonly RecordingEntry[] }) {
  const [all, setAll] = useState(false);
  if (entries.length === 0) return <p className="empty">Nothing has been recorded yet.</p>;
  return (
    <>
      <ul className="recordings" aria-label="Recordings">
        {(all ? entries : entries.slice(0, SHOWN_AT_FIRST)).map((entry) => (
          <li key={entry.name} className="recording-row">
            <span>{startOf(entry.started)}</span>
            <span className="hint">
              {!entry.whole && (
                <span className="tag tag-caution" title="A crash cut it off; what is before the cut can be read.">
                  cut off
                </span>
              )}{" "}
              {!entry.pictures && "no pictures"}
            </span>
            <span className="number">{clockOf(entry.seconds)}</span>
            <span className="number">{sizeOf(entry.size)}</span>
            <span className="recording-actions">
              <button
                type="button"
                className="link-button"
                aria-label={`Replay ${entry.name}`}
                onClick={() => void startReplay(entry.name)}
              >
                Replay
              </button>
              <a
                href={rerunViewerOf(robot, entry.name, location.origin)}
                target="_blank"
                rel="noreferrer"
                aria-label={`Open ${entry.name} in Rerun`}
              >
                Rerun
              </a>
              <a
                href={rerunFileOf(robot, entry.name)}
                download={entry.name.replace(/\.mcap$/, ".rrd")}
                aria-label={`Download ${entry.name} as .rrd`}
              >
                .rrd
              </a>
              <a href={addressOf(robot, entry.name)} download={entry.name} aria-label={`Download ${entry.name}`}>
                .mcap
              </a>
            </span>
          </li>
        ))}
      </ul>
      {entries.length > SHOWN_AT_FIRST && (
        <button type="button" className="link-button" onClick={() => setAll(!all)}>
          {all ? "Show the newest only" : `Show all ${entries.length}`}
        </button>
      )}
    </>
  );
}
