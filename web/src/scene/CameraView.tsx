/** What the robot's cameras see. */
import { NativeSelect } from "@mantine/core";
import { useEffect, useRef } from "react";
import { Switch } from "../components/Switch";
import { useInSight } from "../components/useInSight";
import { spokenAge } from "../console/freshness";
import { usePreferences } from "../console/preferences";
import { type Stamped, useConsole } from "../console/store";
import { useFreshness, useKeys } from "../console/useLatest";
import { FeatureMarks } from "./FeatureMarks";
import { watch } from "./watching";

const PREFIX = "tele/cam/";
/** The calibration page's own picture. */
const DRAWN_UPON = "tele/cam/calibration";

interface CameraPicture {
  stamp_ns: number;
  jpeg: string;
}

export function CameraView() {
  const { features, camera } = usePreferences();
  const keys = useKeys(PREFIX).filter((name) => name !== DRAWN_UPON);
  const key = keys.find((candidate) => candidate === camera) ?? keys[0];
  const view = useRef<HTMLDivElement>(null);
  const seen = useInSight(view);
  useEffect(() => {
    watch({ cameras: seen, features: seen && features });
  }, [seen, features]);
  useEffect(() => () => watch({ cameras: false, features: false }), []);
  return (
    <div className="camera" ref={view}>
      {key === undefined ? <p className="view-empty">No picture yet</p> : <Picture source={key} features={features} />}
      <div className="camera-features">
        <Switch
          label="Tracked features"
          checked={features}
          onChange={(on) => usePreferences.setState({ features: on })}
        />
      </div>
      {keys.length > 1 && (
        <NativeSelect
          className="camera-choice"
          aria-label="Camera"
          size="xs"
          value={key}
          onChange={(event) => usePreferences.setState({ camera: event.currentTarget.value })}
          data={keys.map((name) => ({ value: name, label: name.slice(PREFIX.length) }))}
        />
      )}
    </div>
  );
}

function Picture({ source, features }: { source: string; features: boolean }) {
  const picture = useConsole((state) => (state.values[source] as Stamped<CameraPicture> | undefined)?.value);
  const { level, age } = useFreshness(source);
  if (picture === undefined || level === "lost") {
    return <p className="view-empty">Picture lost{level === "lost" ? ` ${spokenAge(age)} ago` : ""}</p>;
  }
  return (
    <>
      <img
        src={`data:image/jpeg;base64,${picture.jpeg}`}
        alt={`Picture of camera ${source.slice(PREFIX.length)}`}
        data-freshness={level}
      />
      {features && <FeatureMarks camera={source.slice(PREFIX.length)} stamp_ns={picture.stamp_ns} />}
      {level === "stale" && <span className="view-age">{spokenAge(age)} old</span>}
    </>
  );
}
