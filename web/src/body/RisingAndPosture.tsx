/** How the robot stands up and sits down, and in which posture its legs are. */
import { NativeSelect } from "@mantine/core";
import { CommandButton } from "../components/CommandButton";
import { sentence } from "../components/format";
import { command } from "../console/commands";
import { selectedRobot, useHindrance } from "../console/control";
import { useConsole } from "../console/store";
import { useLatest } from "../console/useLatest";

export function RisingAndPosture() {
  const robot = useConsole(selectedRobot)?.motion;
  const orders = useLatest("state/motion");
  const posture = useLatest("tele/locomotion")?.leg_posture ?? "";
  const hindrance = useHindrance("set_start_up");
  return (
    <div className="body-part" role="group" aria-label="Rising and posture">
      <div className="button-row">
        <NativeSelect
          aria-label="How to stand up"
          size="xs"
          value={orders?.in_sequence ? "sequence" : "direct"}
          disabled={hindrance !== null}
          title={hindrance ?? undefined}
          onChange={(event) => void command("set_start_up", { name: event.currentTarget.value })}
        >
          <option value="direct">Rise on all legs at once</option>
          <option value="sequence">Rise in groups of legs</option>
        </NativeSelect>
        {robot?.packs && (
          <CommandButton name="sit" size="xs" variant="default" onPress={() => void command("sit", { name: "pack" })}>
            Pack the legs
          </CommandButton>
        )}
        {(robot?.postures ?? []).map((name) => (
          <CommandButton
            key={name}
            name="change_posture"
            size="xs"
            variant={name === posture ? "filled" : "default"}
            onPress={() => void command("change_posture", { name })}
          >
            {sentence(name)}
          </CommandButton>
        ))}
      </div>
    </div>
  );
}
