/** The page: top bar, views on the left, panels on the right. */
import { Suspense, lazy } from "react";
import { AdaptationPanel } from "./adaptation/AdaptationPanel";
import { BodyPanel } from "./body/BodyPanel";
import { CALIBRATION, useAddress } from "./calibration/address";
import { useConsole } from "./console/store";
import { EventLog } from "./events/EventLog";
import { Notices } from "./events/Notices";
import { MissionPanel } from "./mission/MissionPanel";
import { useUndoKeys } from "./mission/useUndoKeys";
import { RecordingPanel } from "./recording/RecordingPanel";
import { ReplayBar } from "./replay/ReplayBar";
import { SettingsPanel } from "./settings/SettingsPanel";
import { useIsReplay } from "./replay/commands";
import { RobotPanel } from "./robot/RobotPanel";
import { Views } from "./scene/Views";
import { StatusPanel } from "./status/StatusPanel";
import { useStopKeys } from "./stop/useStopKeys";
import { TeleopPanel } from "./teleop/TeleopPanel";
import { TopBar } from "./topbar/TopBar";

const CalibrationPage = lazy(() => import("./calibration/CalibrationPage"));

export function App() {
  useStopKeys();
  useUndoKeys();
  const connected = useConsole((state) => state.connection === "open");
  const address = useAddress();
  return (
    <div className="page" data-connected={connected}>
      <TopBar />
      {address === CALIBRATION ? (
        <Suspense>
          <CalibrationPage />
        </Suspense>
      ) : (
        <Work />
      )}
      <Notices />
    </div>
  );
}

function Work() {
  const replay = useIsReplay();
  return (
    <main className="work">
      <div className="work-views" data-replay={replay}>
        <Views />
        {replay && <ReplayBar />}
        <EventLog />
      </div>
      <div className="work-panels">
        <div className="panel-column">
          <MissionPanel />
          <RobotPanel />
          {replay ? null : (
            <>
              <TeleopPanel />
              <BodyPanel />
            </>
          )}
        </div>
        <div className="panel-column">
          <AdaptationPanel />
          <StatusPanel />
          {replay ? null : (
            <>
              <RecordingPanel />
              <SettingsPanel />
            </>
          )}
        </div>
      </div>
    </main>
  );
}
