/** Says that the console is gone, for how long, and what that means. */
import { Button } from "@mantine/core";
import { spokenAge } from "../console/freshness";
import { reconnectNow } from "../console/session";
import { useConsole } from "../console/store";

export function ConnectionBanner() {
  const connection = useConsole((state) => state.connection);
  const age = useConsole((state) =>
    state.lostAt === null ? 0 : Math.max(0, Math.round((state.now - state.lostAt) / 1000)),
  );
  const stopPending = useConsole((state) => state.stopPending);
  switch (connection) {
    case "open":
    case "connecting":
      return null;
    case "replaced":
      return (
        <p className="banner banner-danger" role="alert">
          This page was opened elsewhere and is no longer connected.{" "}
          <Button size="compact-xs" variant="white" onClick={reconnectNow}>
            Connect here again
          </Button>
        </p>
      );
    case "login":
      return (
        <p className="banner banner-danger" role="alert">
          The console wants you to log in, as your time is up or your access has changed.{" "}
          <a href="/">Go to the login</a>. The robot holds by itself when it loses its operator.
        </p>
      );
    case "lost":
      return (
        <p className="banner banner-danger" role="alert">
          <strong>Console unreachable</strong> for <span aria-hidden>{spokenAge(age)}</span>. Values below are old. The
          robot holds by itself within a second of losing its operator. Trying again.
          {stopPending && <strong> Your stop has not been sent yet.</strong>}
        </p>
      );
  }
}
