/** Asking who has control to hand it over: the polite way, beside taking it with a reason. */
import { Button } from "@mantine/core";
import { unreachable } from "../console/control";
import { send } from "../console/outbox";
import { useConsole } from "../console/store";

export function AskButton({ owner, held }: { owner: string; held: boolean }) {
  const asking = useConsole((state) => state.asking);
  const hindered = useConsole((state) => unreachable(state) !== null);
  if (held || owner === "") return null;
  return (
    <Button
      size="xs"
      variant="default"
      loading={asking !== null}
      disabled={hindered}
      title={asking === null ? `${owner} is asked and may hand over or decline` : asking.text}
      onClick={() => send({ type: "ask_for_control", reason: "" })}
    >
      Ask for control
    </Button>
  );
}
