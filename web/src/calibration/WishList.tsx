/** What a good calibration has, met or missing: in words and by a sign. */
import type { CalibrationWish } from "../protocol/messages";

export function WishList({ label, wishes }: { label: string; wishes: readonly CalibrationWish[] }) {
  const met = wishes.filter((wish) => wish.met).length;
  return (
    <ul className="wishes" aria-label={`${label}, ${met} of ${wishes.length} met`}>
      {wishes.map((wish, k) => (
        <li key={k} data-met={wish.met}>
          <Sign met={wish.met} />
          <span>{wish.what}</span>
        </li>
      ))}
    </ul>
  );
}

export function Sign({ met }: { met: boolean }) {
  return (
    <>
      <span aria-hidden>{met ? "✓" : "○"}</span>
      <span className="visually-hidden">{met ? "met:" : "missing:"}</span>
    </>
  );
}
