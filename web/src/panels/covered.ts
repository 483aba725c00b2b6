import { place } from "./dom";
import type { Covered } from "../viewer/rig";

/** How much of the picture lies under view buttons, dock and cards [CSS pixels]; the style sheet hears of it too. */
export function covered(): Covered {
  const stage = place("stage");
  const width = place("view").clientWidth;
  const bottom = stage.clientHeight - place("dock").offsetTop;
  const { offsetLeft, offsetWidth, offsetHeight } = place("cards");
  const right = offsetHeight > 0 ? offsetLeft + offsetWidth : 0;
  // Where a card takes most of a narrow picture, the scene stays behind it.
  const left = right < 0.6 * width ? right : 0;
  stage.style.setProperty("--covered", `${bottom}px`);
  stage.style.setProperty("--covered-left", `${left}px`);
  return { left, top: 48, bottom };
}
