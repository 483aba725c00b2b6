import { beforeEach, expect, test } from "vitest";
import { skipLinks } from "../../../web/src/app/skip_links";
import { make } from "../../../web/src/dom/elements";
import { oneTabStop } from "../../../web/src/dom/toolbar";

beforeEach(() => {
  document.body.className = "";
  const panel = make("aside", { id: "panel" });
  const toggle = make("button", { id: "panel-toggle", onclick: () => document.body.classList.add("panel-open") });
  const parts = [make("canvas", { id: "view", tabIndex: 0 }), panel, make("aside", { id: "student" }), toggle];
  document.body.replaceChildren(skipLinks(), ...parts);
});

const follow = (words: string) => {
  [...document.querySelectorAll("a")].find(({ textContent }) => textContent === words)!.click();
  return document.activeElement?.id;
};

test("ASkipLinkMovesTheFocusAndKeepsTheAddress", () => {
  expect(follow("Skip to the picture")).toBe("view");
  expect(follow("Skip to the controls")).toBe("panel");
  expect(document.body.classList.contains("panel-open")).toBe(true);
  document.body.classList.add("student");
  expect(follow("Skip to the controls")).toBe("student");
  expect(location.hash).toBe("");
});

test("AToolbarIsOneTabStopAndArrowKeysMoveWithinIt", () => {
  const buttons = ["a", "b", "c"].map((id) => make("button", { id, ariaPressed: "false" }));
  buttons[1].setAttribute("aria-pressed", "true");
  const bar = make("div", {}, ...buttons);
  document.body.append(bar);
  const update = oneTabStop(bar);
  update();
  const stops = () => buttons.map(({ tabIndex }) => tabIndex);
  expect(stops()).toEqual([-1, 0, -1]);
  buttons[1].focus();
  const press = (key: string) => {
    document.activeElement!.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
    return document.activeElement!.id;
  };
  expect(["ArrowRight", "ArrowRight", "ArrowLeft", "Home", "End"].map(press)).toEqual(["c", "a", "c", "a", "c"]);
  expect(stops()).toEqual([-1, -1, 0]);
  update();
  expect(stops(), "a focused button stays the stop").toEqual([-1, -1, 0]);
});
