/** The timeline of a replay: play, pause, speed, and going to any moment or event of it. */
import { Button, NativeSelect } from "@mantine/core";
import { useEffect, useState } from "react";
import { useThrottle } from "../components/useThrottle";
import { command } from "../console/commands";
import { useLatest } from "../console/useLatest";
import type { ReplayMark, ReplayState } from "../protocol/messages";
import { clockOf } from "../recording/figures";
import { endReplay } from "./commands";
import { MarkTicks } from "./MarkTicks";
import { ReplayEvents } from "./ReplayEvents";
import { SPEEDS, landing, neighbourMark } from "./timeline";

const JUMP_PERIOD = 200; // ms
/** How long the operator's wish is shown before the replay has got there, ms. */
const PATIENCE = 900;
const STEP = 0.1; // s
const NO_MARKS: readonly ReplayMark[] = [];

export function ReplayBar() {
  const replay = useLatest("state/replay");
  const marks = useLatest("state/replay_marks")?.marks ?? NO_MARKS;
  if (replay === undefined) return <p className="view-empty">Waiting for the recording…</p>;
  return <Timeline replay={replay} marks={marks} />;
}

function Timeline({ replay, marks }: { replay: ReplayState; marks: readonly ReplayMark[] }) {
  const { seconds, length, speed, robot_id, recording } = replay;
  const [wanted, setWanted] = useState<number | null>(null);
  const [pace, setPace] = useState(1);
  const throttled = useThrottle(JUMP_PERIOD);
  const shown = wanted ?? seconds;
  useEffect(() => {
    if (wanted === null) return;
    const timer = setTimeout(() => setWanted(null), PATIENCE);
    return () => clearTimeout(timer);
  }, [wanted]);

  const play = (value: number) => void command("play_replay", { value });
  const go = (place: number) => {
    setWanted(place);
    throttled(() => void command("jump_replay", { value: place }));
  };
  const goTo = (mark: ReplayMark | undefined) => mark !== undefined && go(landing(mark));
  const [before, after] = [neighbourMark(marks, shown, -1), neighbourMark(marks, shown, 1)];

  return (
    <section className="replay" aria-label="Replay">
      <div className="replay-line">
        <Button size="xs" className="replay-play" onClick={() => play(speed > 0 ? 0 : pace)}>
          {speed > 0 ? "Pause replay" : "Play"}
        </Button>
        <span className="number">{clockOf(shown)}</span>
        <div className="replay-track">
          <MarkTicks marks={marks} length={length} />
          <input
            type="range"
            aria-label="Timeline"
            aria-valuetext={`${clockOf(shown)} of ${clockOf(length)}`}
            min={0}
            max={length}
            step={STEP}
            value={shown}
            onChange={(event) => go(event.currentTarget.valueAsNumber)}
          />
        </div>
        <span className="number">{clockOf(length)}</span>
        <NativeSelect
          aria-label="Replay speed"
          size="xs"
          value={String(speed > 0 ? speed : pace)}
          onChange={(event) => {
            const chosen = Number(event.currentTarget.value);
            setPace(chosen);
            if (speed > 0) play(chosen);
          }}
          data={SPEEDS.map((value) => ({ value: String(value), label: `${value} ×` }))}
        />
        {([["Previous", before], ["Next", after]] as const).map(([side, mark]) => (
          <Button
            key={side}
            size="xs"
            variant="default"
            aria-label={`${side} event`}
            disabled={mark === undefined}
            onClick={() => goTo(mark)}
          >
            {side}
          </Button>
        ))}
        <Button size="xs" variant="default" onClick={() => void endReplay(robot_id)}>
          End replay
        </Button>
      </div>
      <ReplayEvents marks={marks} seconds={shown} onGo={goTo} recording={recording} />
    </section>
  );
}
