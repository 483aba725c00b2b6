import { beforeEach, expect, test } from "vitest";
import { shortcuts } from "../../../web/src/app/shortcuts";
import { make } from "../../../web/src/dom/elements";

let heard: string[];
let inLesson = false;
const press = (target: Element, key: string, more: KeyboardEventInit = {}) =>
  target.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, ...more }));

beforeEach(() => {
  heard = [];
  const keys = [
    { key: " ", description: "Play, pause", run: () => heard.push("play") },
    { key: "g", description: "Graphs", run: () => heard.push("graphs") },
    { key: "PageDown", description: "Next step", when: () => inLesson, run: () => heard.push("next") },
  ];
  const dialog = shortcuts(
    keys,
    () => heard.push("undo"),
    () => heard.push("redo"),
  );
  document.body.replaceChildren(dialog, make("input"), make("button"), make("main"));
});

test("KeysWorkUnlessAnInputHasFocus", () => {
  const [input, button, page] = ["input", "button:last-of-type", "main"].map((name) => document.querySelector(name)!);
  press(page, " ");
  press(page, "g");
  press(input, "g");
  press(button, " ");
  press(page, "z", { ctrlKey: true });
  press(page, "Z", { ctrlKey: true, shiftKey: true });
  press(page, "g", { ctrlKey: true });
  expect(new Set(heard)).toEqual(new Set(["play", "graphs", "undo", "redo"]));
  expect(heard.filter((each) => each === "graphs")).toHaveLength(1);
});

test("AKeyWithoutAnActionNowIsLeftToTheBrowser", () => {
  const pageDown = () => new KeyboardEvent("keydown", { key: "PageDown", bubbles: true, cancelable: true });
  const [scrolls, turns] = [pageDown(), pageDown()];
  document.querySelector("main")!.dispatchEvent(scrolls);
  expect([scrolls.defaultPrevented, heard]).toEqual([false, []]);
  inLesson = true;
  document.querySelector("main")!.dispatchEvent(turns);
  inLesson = false;
  expect(turns.defaultPrevented).toBe(true);
  expect(new Set(heard)).toEqual(new Set(["next"]));
});

test("TheDialogListsEveryKey", () => {
  const keys = [...document.querySelectorAll("kbd")].map((each) => each.textContent);
  expect(keys).toEqual(expect.arrayContaining(["Space", "G", "?", "Ctrl Z, Ctrl Shift Z"]));
});
