import { expect, it } from "vitest";
import { isStopKey } from "../src/stop/keys";

const key = (name: string, code: string, ctrlKey = false) => ({
  key: name,
  code,
  repeat: false,
  ctrlKey,
  altKey: false,
  metaKey: false,
});

it("stops on Escape everywhere, on Space only where it is not typed", () => {
  expect(isStopKey(key("Escape", "Escape"), true)).toBe(true);
  expect(isStopKey(key("Escape", "Escape"), false)).toBe(true);
  expect(isStopKey(key(" ", "Space"), false)).toBe(true);
  expect(isStopKey(key(" ", "Space"), true)).toBe(false);
});

it("leaves other keys and the browser's own combinations alone", () => {
  expect(isStopKey(key("s", "KeyS"), false)).toBe(false);
  expect(isStopKey(key(" ", "Space", true), false)).toBe(false);
});
