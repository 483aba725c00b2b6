import { elementById } from "../dom/elements";
import { readMotion } from "../frames/clip";
import { MotionPage } from "./page";

// The panels are open: the page has no buttons for them.
document.body.classList.add("graphs-open", "panel-open");
try {
  new MotionPage(readMotion(elementById("motion").textContent ?? "")).start();
} catch (error) {
  const reason = error instanceof Error ? error.message : String(error);
  elementById("loading").textContent =
    error instanceof RangeError
      ? `This file is damaged (${reason}): export it again.`
      : `This browser cannot draw the scene (${reason}): the page needs WebGL 2.`;
  throw error;
}
