/** Taking control from somebody needs a reason, which both operators and the log see. */
import { Button, Group, Modal, TextInput } from "@mantine/core";
import { type FormEvent, useState } from "react";

interface TakeOverDialogProps {
  opened: boolean;
  owner: string;
  onCancel(): void;
  onTake(reason: string): void;
}

export function TakeOverDialog({ opened, owner, onCancel, onTake }: TakeOverDialogProps) {
  const [reason, setReason] = useState("");
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (reason.trim() !== "") onTake(reason.trim());
  };
  return (
    <Modal opened={opened} onClose={onCancel} title={`Take control from ${owner}?`} centered>
      <form onSubmit={submit}>
        <TextInput
          label="Reason"
          description={`${owner} is told, and it is written to the log.`}
          value={reason}
          onChange={(event) => setReason(event.currentTarget.value)}
          data-autofocus
          maxLength={120}
        />
        <Group justify="flex-end" mt="md">
          <Button variant="default" onClick={onCancel}>
            Cancel
          </Button>
          <Button type="submit" disabled={reason.trim() === ""}>
            Take over
          </Button>
        </Group>
      </form>
    </Modal>
  );
}
