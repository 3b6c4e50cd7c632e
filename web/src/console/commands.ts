/** Asking the robot for something, and what became of it. Refusals and remarks reach the operator as a notice. */
import type { CommandName } from "../protocol/messages";
import type { Answer, CommandFields } from "../protocol/wire";
import { notify } from "./notices";
import { send } from "./outbox";
import { useConsole } from "./store";

const ANSWER_TIMEOUT = 4000; // ms, longer than the console waits for the robot

type Outcome = Pick<Answer, "accepted" | "reason" | "applied_value">;

interface Question {
  settle(outcome: Outcome): void;
  timer: ReturnType<typeof setTimeout>;
}

const unanswered = new Map<string, Question>();
let lastId = 0;

export function command(name: CommandName, fields: CommandFields = {}): Promise<Outcome> {
  const id = String(++lastId);
  if (!send({ type: "command", id, command: name, ...fields })) {
    return Promise.resolve(reported(name, refusal("the console is unreachable")));
  }
  return new Promise((resolve) => {
    const settle = (outcome: Outcome) => {
      clearTimeout(unanswered.get(id)?.timer);
      unanswered.delete(id);
      resolve(reported(name, outcome));
    };
    const timer = setTimeout(() => settle(refusal("there was no answer within 4 s")), ANSWER_TIMEOUT);
    unanswered.set(id, { settle, timer });
  });
}

/** Stops the robot now, or as soon as the console can be reached again. */
export function stopRobot(): void {
  const { selected, robots } = useConsole.getState();
  const stoppable = robots.filter((robot) => robot.kind !== "REPLAY");
  if (selected === null && stoppable.length === 0) {
    notify("warning", "No robot is selected, so there is nothing to stop.");
    return;
  }
  // NOTE: who stops while looking at a recording means whatever moves.
  const replay = robots.some((robot) => robot.id === selected && robot.kind === "REPLAY");
  const targets = selected === null || replay ? stoppable.map((robot) => robot.id) : [selected];
  for (const robot of targets) {
    const id = String(++lastId);
    if (send({ type: "command", id, command: "stop", robot })) continue;
    useConsole.setState({ stopPending: true });
    notify(
      "error",
      "Stop could not be sent: the console is unreachable. It will be sent on reconnection; use the robot's own switch.",
    );
  }
}

export function settleAnswer(answer: Answer): void {
  const question = answer.id === null ? undefined : unanswered.get(answer.id);
  if (question !== undefined) question.settle(answer);
  else if (!answer.accepted) reported(answer.command, answer);
}

export function settleAllUnanswered(reason: string): void {
  for (const question of [...unanswered.values()]) question.settle(refusal(reason));
}

function refusal(reason: string): Outcome {
  return { accepted: false, reason, applied_value: null };
}

function reported(name: string, outcome: Outcome): Outcome {
  if (!outcome.accepted) notify("error", `${spoken(name)} was refused: ${outcome.reason}`);
  else if (outcome.reason !== "") notify("info", `${spoken(name)}: ${outcome.reason}`);
  return outcome;
}

/** "set_override" -> "Set override". */
function spoken(name: string): string {
  const words = name.replaceAll("_", " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}
