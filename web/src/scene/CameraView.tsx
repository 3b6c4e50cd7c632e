/** What the robot's cameras see. */
import { NativeSelect } from "@mantine/core";
import { useEffect } from "react";
import { spokenAge } from "../console/freshness";
import { send } from "../console/outbox";
import { usePreferences } from "../console/preferences";
import { type Stamped, useConsole } from "../console/store";
import { useFreshness, useKeys } from "../console/useLatest";

const PREFIX = "tele/cam/";
/** The calibration page's own picture. */
const DRAWN_UPON = "tele/cam/calibration";

interface CameraPicture {
  jpeg: string;
}

export function CameraView() {
  const { cameras, camera } = usePreferences();
  const keys = useKeys(PREFIX).filter((name) => name !== DRAWN_UPON);
  const key = keys.find((candidate) => candidate === camera) ?? keys[0];
  useEffect(() => {
    send({ type: "watch", cameras });
  }, [cameras]);
  return (
    <div className="camera">
      {key === undefined ? (
        <p className="view-empty">{cameras ? "No picture yet" : "Pictures are off"}</p>
      ) : (
        <Picture source={key} />
      )}
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

function Picture({ source }: { source: string }) {
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
      {level === "stale" && <span className="view-age">{spokenAge(age)} old</span>}
    </>
  );
}
