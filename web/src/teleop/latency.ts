/** How fast may be driven over a slow link: what the operator sees is old by the round trip. Pure. */

/** Round trip up to which the full speed is allowed, and from which on only the least, s. */
const QUICK = 0.15;
const SLOW = 0.6;
const LEAST = 0.2;

/** Share of the speed, 1 to 0.2; the least while nothing is known. */
export function allowedShare(roundTrip: number | null): number {
  if (roundTrip === null || !Number.isFinite(roundTrip)) return LEAST;
  const share = 1 - ((1 - LEAST) * (roundTrip - QUICK)) / (SLOW - QUICK);
  return Math.min(1, Math.max(LEAST, share));
}
