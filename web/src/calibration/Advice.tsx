/** What to do next, said aloud as it changes. */
import { sentence } from "../components/format";

export function Advice({ text }: { text: string }) {
  return (
    <p className="advice" role="status" aria-label="What to do next">
      {sentence(text)}
    </p>
  );
}
