/** Numbers as people read them; an unknown one is a dash. */

export const UNKNOWN = "–";

export function fixed(value: number | null | undefined, digits: number): string {
  if (typeof value !== "number" || !Number.isFinite(value)) return UNKNOWN;
  const text = value.toFixed(digits);
  return Number(text) === 0 ? text.replace("-", "") : text;
}

export function degrees(radians: number | null | undefined, digits = 1): string {
  return typeof radians === "number" ? fixed((radians * 180) / Math.PI, digits) : UNKNOWN;
}

export function percent(fraction: number | null | undefined, digits = 0): string {
  return typeof fraction === "number" ? fixed(100 * fraction, digits) : UNKNOWN;
}

export function milliseconds(seconds: number | null | undefined, digits = 0): string {
  return typeof seconds === "number" ? fixed(1000 * seconds, digits) : UNKNOWN;
}

export function sentence(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
