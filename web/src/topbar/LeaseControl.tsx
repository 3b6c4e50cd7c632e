/** Who holds the robot, and how to take or give back control. */
import { Button } from "@mantine/core";
import { useState } from "react";
import { onlyWatching } from "../access/role";
import { command } from "../console/commands";
import { expectRelease } from "../console/controlLoss";
import { holder, holdsControl, selectedRobot } from "../console/control";
import { useConsole } from "../console/store";
import { AskButton } from "./AskButton";
import { RealRobotDialog } from "./RealRobotDialog";
import { TakeOverDialog } from "./TakeOverDialog";

export function LeaseControl() {
  const held = useConsole(holdsControl);
  const owner = useConsole(holder);
  const robot = useConsole(selectedRobot);
  const watching = useConsole(onlyWatching);
  const connected = useConsole((state) => state.connection === "open");
  const [asking, setAsking] = useState(false);
  const [waiting, setWaiting] = useState(false);
  const [confirming, setConfirming] = useState(false);

  const ask = async (name: "take_control" | "release_control", reason?: string) => {
    setAsking(false);
    setWaiting(true);
    if (name === "release_control") expectRelease();
    await command(name, reason === undefined ? {} : { reason });
    setWaiting(false);
  };

  const take = () => {
    setConfirming(false);
    if (owner === "") void ask("take_control");
    else setAsking(true);
  };

  if (robot?.kind === "REPLAY") {
    return (
      <div className="lease">
        <span className="lease-holder">{owner === "" ? "Nobody had control" : `${owner} had control`}</span>
      </div>
    );
  }
  return (
    <div className="lease">
      <span className="lease-holder" data-held={held && connected}>
        {!connected
          ? "Control unknown"
          : held
            ? "You have control"
            : owner === ""
              ? "Nobody has control"
              : `${owner} has control`}
      </span>
      {held ? (
        <Button
          size="xs"
          variant="default"
          loading={waiting}
          disabled={!connected}
          onClick={() => void ask("release_control")}
        >
          Release control
        </Button>
      ) : (
        <Button
          size="xs"
          loading={waiting}
          disabled={!connected || robot === undefined || !robot.alive || watching !== null}
          title={watching ?? undefined}
          onClick={() => (robot?.kind === "REAL" ? setConfirming(true) : take())}
        >
          Take control
        </Button>
      )}
      <AskButton owner={owner} held={held} />
      <RealRobotDialog
        opened={confirming}
        robot={robot?.id ?? ""}
        onCancel={() => setConfirming(false)}
        onConfirm={take}
      />
      <TakeOverDialog
        opened={asking}
        owner={owner}
        onCancel={() => setAsking(false)}
        onTake={(why) => void ask("take_control", why)}
      />
    </div>
  );
}
