/** What an operator must see at every moment; it never scrolls away. */
import { Account } from "../access/Account";
import { selectedRobot } from "../console/control";
import { useConsole } from "../console/store";
import { ConnectionBanner } from "./ConnectionBanner";
import { ControlRequests } from "./ControlRequests";
import { KIND_CLASS, bannerText } from "./kinds";
import { LeaseControl } from "./LeaseControl";
import { LinkReadings } from "./LinkReadings";
import { PowerReadings } from "./PowerReadings";
import { RobotPicker } from "./RobotPicker";
import { StatusPill } from "./StatusPill";
import { StopButton } from "./StopButton";
import { ThemeToggle } from "./ThemeToggle";

export function TopBar() {
  const robot = useConsole(selectedRobot);
  return (
    <header className="top">
      <div className="top-bar">
        <h1 className="brand">Weaver</h1>
        <RobotPicker />
        <StatusPill />
        <LeaseControl />
        <LinkReadings />
        <PowerReadings />
        <Account />
        <ThemeToggle />
        <StopButton />
      </div>
      {robot !== undefined && (
        <p className={`banner ${KIND_CLASS[robot.kind]}`}>{bannerText(robot.kind, robot.world)}</p>
      )}
      {robot !== undefined && robot.conflict !== "" && (
        <p className="banner banner-danger" role="alert">
          {robot.conflict}
        </p>
      )}
      <ControlRequests />
      <ConnectionBanner />
    </header>
  );
}
