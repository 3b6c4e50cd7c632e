/** A button for one command of the robot: disabled, with the reason, while the robot would refuse it. */
import { Button, type ButtonProps } from "@mantine/core";
import { command } from "../console/commands";
import { useHindrance } from "../console/control";
import type { CommandName } from "../protocol/messages";

interface CommandButtonProps extends ButtonProps {
  name: CommandName;
  /** What to do instead of sending the bare command. */
  onPress?: () => void;
}

export function CommandButton({ name, onPress, children, ...look }: CommandButtonProps) {
  const hindrance = useHindrance(name);
  return (
    <Button
      {...look}
      disabled={hindrance !== null}
      title={hindrance ?? undefined}
      onClick={onPress ?? (() => void command(name))}
    >
      {children}
    </Button>
  );
}
