/** Before control of a real robot is taken: its battery, what it finds wrong with itself, and that it is real. */
import { Button, Group, List, Modal, Text } from "@mantine/core";
import { useLatest } from "../console/useLatest";
import { selfTest } from "./selfTest";

interface RealRobotDialogProps {
  opened: boolean;
  robot: string;
  onCancel(): void;
  onConfirm(): void;
}

export function RealRobotDialog({ opened, robot, onCancel, onConfirm }: RealRobotDialogProps) {
  const { battery, troubles } = selfTest(useLatest("tele/power"), useLatest("state/mode"));
  return (
    <Modal opened={opened} onClose={onCancel} title={`${robot} is a real robot`} centered>
      <Text size="sm">Its motors will move under your orders. Keep people and cables clear of the legs.</Text>
      <Text size="sm" mt="sm">
        Battery: {battery}
      </Text>
      <Text size="sm" mt="sm">
        Self-test: {troubles.length === 0 ? "nothing is wrong" : "see what the robot says"}
      </Text>
      {troubles.length > 0 && (
        <List size="sm">
          {troubles.map((text) => (
            <List.Item key={text}>{text}</List.Item>
          ))}
        </List>
      )}
      <Group justify="flex-end" mt="md">
        <Button variant="default" onClick={onCancel} data-autofocus>
          Leave it
        </Button>
        <Button color="red" onClick={onConfirm}>
          Yes, it is real
        </Button>
      </Group>
    </Modal>
  );
}
