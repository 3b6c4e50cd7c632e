/** Asks for the next picture in full resolution: the ground ahead finer and surer, in the map. Needs no control. */
import { Button } from "@mantine/core";
import { useState } from "react";
import { command } from "../console/commands";
import { unreachable } from "../console/control";
import { notify } from "../console/notices";
import { useConsole } from "../console/store";

export function LookClosely() {
  const hindrance = useConsole(unreachable);
  const [waiting, setWaiting] = useState(false);
  const look = async () => {
    setWaiting(true);
    const { accepted, applied_value: cells } = await command("look_closely");
    setWaiting(false);
    if (accepted && cells !== null && cells > 0) notify("info", `Look closely measured ${cells} cells of the map.`);
  };
  return (
    <Button
      variant="default"
      size="xs"
      loading={waiting}
      disabled={hindrance !== null}
      title={hindrance ?? "One picture at full resolution into the map"}
      onClick={() => void look()}
    >
      Look closely
    </Button>
  );
}
