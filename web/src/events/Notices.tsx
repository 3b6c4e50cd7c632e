/** Refusals and warnings over the page, read out as they come. */
import { CloseButton } from "@mantine/core";
import { dismiss } from "../console/notices";
import { useConsole } from "../console/store";

const WORDS = { info: "Note", warning: "Warning", error: "Refused or failed" } as const;

export function Notices() {
  const notices = useConsole((state) => state.notices);
  return (
    <div className="notices" role="alert">
      {notices.map((notice) => (
        <div key={notice.id} className="notice" data-severity={notice.severity}>
          <p>
            <strong className="visually-hidden">{WORDS[notice.severity]}: </strong>
            {notice.text}
          </p>
          <CloseButton size="sm" aria-label="Dismiss" onClick={() => dismiss(notice.id)} />
        </div>
      ))}
    </div>
  );
}
