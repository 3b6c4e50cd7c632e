/** Who has logged in and as what; nothing where nobody needs to. */
import { Button } from "@mantine/core";
import { useConsole } from "../console/store";

export function Account() {
  const user = useConsole((state) => state.hello?.user ?? "");
  const role = useConsole((state) => state.hello?.role ?? "admin");
  if (user === "") return null;
  return (
    <div className="account">
      <span>
        {user}
        <span className="account-role">{role}</span>
      </span>
      <Button size="compact-xs" variant="default" onClick={() => void logOut()}>
        Log out
      </Button>
    </div>
  );
}

async function logOut(): Promise<void> {
  await fetch("api/logout", { method: "POST" });
  location.reload(); // the console answers with its login
}
