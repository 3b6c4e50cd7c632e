/** One waypoint: its coordinates and what can be done with it. */
import { ActionIcon } from "@mantine/core";
import type { Waypoint } from "../protocol/messages";
import { CoordinateInput } from "./CoordinateInput";
import type { DraftAction } from "./draft";
import { useDraft } from "./draftStore";
import { pointAfter } from "./path";

interface WaypointRowProps {
  index: number;
  waypoint: Waypoint;
  count: number;
  selected: boolean;
  /** The robot is on its way to this one. */
  next: boolean;
  dispatch(action: DraftAction): void;
}

export function WaypointRow({ index, waypoint, count, selected, next, dispatch }: WaypointRowProps) {
  const name = `waypoint ${index + 1}`;
  const insert = () => {
    const { waypoints } = useDraft.getState().draft;
    dispatch({ type: "insert", index: index + 1, waypoint: pointAfter(waypoints, index) });
  };
  return (
    <li className="waypoint" aria-current={next ? "step" : undefined} data-selected={selected}>
      <button
        type="button"
        className="waypoint-number"
        aria-label={`Select ${name}`}
        aria-pressed={selected}
        onClick={() => dispatch({ type: "select", index: selected ? null : index })}
      >
        {next ? "▸" : ""}
        {index + 1}
      </button>
      <CoordinateInput
        label="x"
        name={name}
        value={waypoint.x}
        onCommit={(x) => dispatch({ type: "place", index, waypoint: { ...waypoint, x } })}
      />
      <CoordinateInput
        label="y"
        name={name}
        value={waypoint.y}
        onCommit={(y) => dispatch({ type: "place", index, waypoint: { ...waypoint, y } })}
      />
      <span className="waypoint-actions">
        <RowButton label={`Insert after ${name}`} sign="+" onPress={insert} />
        <RowButton
          label={`Move ${name} up`}
          sign="↑"
          disabled={index === 0}
          onPress={() => dispatch({ type: "reorder", from: index, to: index - 1 })}
        />
        <RowButton
          label={`Move ${name} down`}
          sign="↓"
          disabled={index === count - 1}
          onPress={() => dispatch({ type: "reorder", from: index, to: index + 1 })}
        />
        <RowButton label={`Delete ${name}`} sign="✕" onPress={() => dispatch({ type: "delete", index })} />
      </span>
    </li>
  );
}

interface RowButtonProps {
  label: string;
  sign: string;
  disabled?: boolean;
  onPress(): void;
}

function RowButton({ label, sign, disabled = false, onPress }: RowButtonProps) {
  return (
    <ActionIcon
      variant="subtle"
      color="gray"
      size="sm"
      aria-label={label}
      title={label}
      disabled={disabled}
      onClick={onPress}
    >
      <span aria-hidden>{sign}</span>
    </ActionIcon>
  );
}
