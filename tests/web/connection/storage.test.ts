import { expect, test } from "vitest";
import { storageOr } from "../../../web/src/dom/storage";

test("APageWhoseBrowserKeepsNothingRemembersForItself", () => {
  const kept = storageOr(() => {
    throw new Error("Access is denied for this document.");
  });
  expect(kept.getItem("a")).toBe(null);
  kept.setItem("a", "1");
  expect(kept.getItem("a")).toBe("1");
});

test("APageUsesWhatItsBrowserKeeps", () => {
  const browser = { getItem: () => "kept", setItem: () => undefined };
  expect(storageOr(() => browser)).toBe(browser);
});
