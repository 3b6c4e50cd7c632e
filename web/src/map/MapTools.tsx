/** Zoom and centre buttons over the map. */
import { ActionIcon } from "@mantine/core";
import type { MapView } from "./useMapView";

export function MapTools({ map }: { map: MapView }) {
  return (
    <div className="map-tools">
      <Tool label="Zoom in" sign="+" onPress={() => map.zoom(1.4)} />
      <Tool label="Zoom out" sign="−" onPress={() => map.zoom(1 / 1.4)} />
      <Tool label="Follow robot" sign="◎" pressed={map.follow} onPress={map.centre} />
    </div>
  );
}

interface ToolProps {
  label: string;
  sign: string;
  pressed?: boolean;
  onPress(): void;
}

function Tool({ label, sign, pressed, onPress }: ToolProps) {
  return (
    <ActionIcon
      variant={pressed === true ? "filled" : "default"}
      size="lg"
      aria-label={label}
      aria-pressed={pressed}
      title={label}
      onClick={onPress}
    >
      <span aria-hidden>{sign}</span>
    </ActionIcon>
  );
}
