/** Keeping the edited mission under a name, and taking a kept one back into the editor. */
import { Button, TextInput } from "@mantine/core";
import { type FormEvent, useCallback, useEffect, useState } from "react";
import { selectedRobot } from "../console/control";
import { notify } from "../console/notices";
import { useConsole } from "../console/store";
import { useDraft } from "./draftStore";
import { type SavedMission, deleteMission, listMissions, saveMission } from "./savedMissions";

export function SavedMissions() {
  const [missions, setMissions] = useState<SavedMission[]>([]);
  const connected = useConsole((state) => state.connection === "open");
  const refresh = useCallback(() => attempt(async () => setMissions(await listMissions())), []);
  useEffect(() => {
    if (connected) void refresh();
  }, [connected, refresh]);
  return (
    <details className="saved-missions" onToggle={(event) => event.currentTarget.open && void refresh()}>
      <summary>Saved missions{missions.length > 0 ? ` (${missions.length})` : ""}</summary>
      <SaveForm missions={missions} onSaved={refresh} />
      {missions.length === 0 && <p className="hint">None yet. Place waypoints and save them under a name.</p>}
      <ul aria-label="Saved missions" role="list">
        {missions.map((mission) => (
          <SavedRow key={mission.name} mission={mission} onDeleted={refresh} />
        ))}
      </ul>
    </details>
  );
}

function SaveForm({ missions, onSaved }: { missions: readonly SavedMission[]; onSaved(): Promise<void> }) {
  const [name, setName] = useState("");
  const waypoints = useDraft((state) => state.draft.waypoints);
  const areas = useDraft((state) => state.draft.areas);
  const operator = useConsole((state) => state.hello?.operator ?? "");
  const robot = useConsole(selectedRobot)?.id ?? "";
  const trimmed = name.trim();
  const known = missions.some((mission) => mission.name === trimmed);
  const save = (event: FormEvent) => {
    event.preventDefault();
    void attempt(async () => {
      await saveMission({ name: trimmed, waypoints: [...waypoints], areas: areas.map((area) => [...area]), operator, robot });
      setName("");
      await onSaved();
    });
  };
  return (
    <form className="saved-form" onSubmit={save}>
      <TextInput
        aria-label="Mission name"
        placeholder="Name of this mission"
        size="xs"
        maxLength={60}
        value={name}
        onChange={(event) => setName(event.currentTarget.value)}
      />
      <Button
        type="submit"
        size="xs"
        variant="default"
        disabled={trimmed === "" || waypoints.length === 0}
        title={waypoints.length === 0 ? "place a waypoint first" : undefined}
      >
        {known ? "Replace" : "Save mission"}
      </Button>
    </form>
  );
}

function SavedRow({ mission, onDeleted }: { mission: SavedMission; onDeleted(): Promise<void> }) {
  const { name, waypoints, areas, operator, saved } = mission;
  const dispatch = useDraft((state) => state.dispatch);
  const remove = () =>
    void attempt(async () => {
      await deleteMission(name);
      await onDeleted();
    });
  return (
    <li className="saved-mission">
      <span className="saved-name">{name}</span>
      <span className="hint">
        {waypoints.length} {waypoints.length === 1 ? "waypoint" : "waypoints"}, {operator === "" ? "" : `${operator}, `}
        {new Date(1000 * saved).toLocaleString([], { dateStyle: "medium", timeStyle: "short" })}
      </span>
      <Button
        size="compact-xs"
        variant="default"
        aria-label={`Load ${name}`}
        onClick={() => dispatch({ type: "load", waypoints, areas })}
      >
        Load
      </Button>
      <Button size="compact-xs" variant="default" aria-label={`Delete ${name}`} onClick={remove}>
        Delete
      </Button>
    </li>
  );
}

/** Failures reach the operator as a notice; nothing that was edited is lost. */
async function attempt(action: () => Promise<void>): Promise<void> {
  try {
    await action();
  } catch (error) {
    notify("error", `Saved missions: ${error instanceof Error ? error.message : String(error)}`);
  }
}
