/** Where the odometry followed features, over the camera's picture: told apart by shape as well as colour. */
import { type Stamped, useConsole } from "../console/store";
import { useFreshness } from "../console/useLatest";
import type { TrackedFeatures } from "../protocol/messages";
import { KINDS, marksOf, together } from "./featureShapes";

interface FeatureMarksProps {
  camera: string;
  /** Of the picture that they are drawn over. */
  stamp_ns: number;
}

export function FeatureMarks({ camera, stamp_ns }: FeatureMarksProps) {
  const key = `tele/features/${camera}`;
  const features = useConsole((state) => (state.values[key] as Stamped<TrackedFeatures> | undefined)?.value);
  const { level } = useFreshness(key);
  if (features === undefined || level === "lost") return <p className="feature-key">No features are told of</p>;
  const counts = KINDS.map(({ kind, label }) => `${features[kind].length} ${label}`);
  return (
    <>
      {together(features, stamp_ns) && (
        <svg
          className="feature-marks"
          viewBox={`0 0 ${features.width} ${features.height}`}
          role="img"
          aria-label={`Tracked features: ${counts.join(", ")}`}
        >
          {KINDS.map(({ kind }) => (
            <path key={kind} className={`feature-${kind}`} d={marksOf(kind, features[kind])} />
          ))}
        </svg>
      )}
      <p className="feature-key">
        {KINDS.map(({ kind, label, sign }) => (
          <span key={kind} className={`feature-${kind}`}>
            {sign} {features[kind].length} {label}
          </span>
        ))}
      </p>
    </>
  );
}
