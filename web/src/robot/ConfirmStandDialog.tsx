/** A real robot stands up only after its name was typed: nobody does that by a slip. */
import { Button, Group, Modal, Text, TextInput } from "@mantine/core";
import { type FormEvent, useEffect, useState } from "react";

interface ConfirmStandDialogProps {
  opened: boolean;
  robot: string;
  onCancel(): void;
  onConfirm(): void;
}

export function ConfirmStandDialog({ opened, robot, onCancel, onConfirm }: ConfirmStandDialogProps) {
  const [typed, setTyped] = useState("");
  useEffect(() => setTyped(""), [opened]);
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (typed === robot) onConfirm();
  };
  return (
    <Modal opened={opened} onClose={onCancel} title="Stand up a real robot?" centered>
      <form onSubmit={submit}>
        <Text size="sm" mb="sm">
          The motors of {robot} switch on and it stands up. Keep people and cables clear.
        </Text>
        <TextInput
          label={`Type ${robot} to go on`}
          value={typed}
          onChange={(event) => setTyped(event.currentTarget.value)}
          data-autofocus
        />
        <Group justify="flex-end" mt="md">
          <Button variant="default" onClick={onCancel}>
            Cancel
          </Button>
          <Button type="submit" color="red" disabled={typed !== robot}>
            Stand up now
          </Button>
        </Group>
      </form>
    </Modal>
  );
}
