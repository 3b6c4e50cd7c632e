/** Who asks this page for control, with both answers. It stays until answered or over; Stop is not covered by it. */
import { Button } from "@mantine/core";
import { expectRelease } from "../console/controlLoss";
import { send } from "../console/outbox";
import { useConsole } from "../console/store";

export function ControlRequests() {
  const requests = useConsole((state) => state.requests);
  const answer = (asker: string, grant: boolean) => {
    if (grant) expectRelease();
    send({ type: "answer_request", asker, grant });
  };
  return requests.map(({ robot, asker, reason, answer_within_s }) => (
    <div key={`${robot} ${asker}`} className="banner banner-request" role="group" aria-label={`Request of ${asker}`}>
      <span>
        <strong>{asker}</strong> asks for control of {robot}
        {reason !== "" && `: ${reason}`}. Without an answer within {answer_within_s} s they are told so.
      </span>
      <Button size="compact-sm" onClick={() => answer(asker, true)}>
        Hand over
      </Button>
      <Button size="compact-sm" variant="default" onClick={() => answer(asker, false)}>
        Decline
      </Button>
    </div>
  ));
}
