/** Body and legs beyond walking: the body's pose, a velocity held, how the robot rises, legs taken in hand. */
import { Panel } from "../components/Panel";
import { useLatest } from "../console/useLatest";
import { CruiseControl } from "./CruiseControl";
import { LegHandling } from "./LegHandling";
import { PoseSliders } from "./PoseSliders";
import { RisingAndPosture } from "./RisingAndPosture";

export function BodyPanel() {
  const orders = useLatest("state/motion");
  const posed = orders?.pose.some((value) => (value ?? 0) !== 0) ?? false;
  const cruising = (orders?.cruise_seconds_left ?? 0) > 0;
  const held = orders?.held_legs.length ?? 0;
  return (
    <Panel
      title="Body and legs"
      className="body"
      aside={
        <span className="panel-aside">
          {cruising && <span className="tag tag-caution">Cruising</span>}
          {posed && <span className="tag">Posed</span>}
          {held > 0 && <span className="tag tag-caution">{held === 1 ? "1 leg" : `${held} legs`} in hand</span>}
        </span>
      }
    >
      <PoseSliders />
      <CruiseControl />
      <LegHandling />
      <RisingAndPosture />
    </Panel>
  );
}
