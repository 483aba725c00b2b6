import { place } from "../dom/elements";
import type { Covered } from "../viewer/camera_rig";

/** How much of the picture lies under view buttons, heads, dock and cards [CSS pixels]; the style sheet hears of it too. */
export function covered(): Covered {
  const stage = place("stage");
  const width = place("view").clientWidth;
  const bottom = stage.clientHeight - place("dock").offsetTop;
  const { offsetLeft, offsetWidth, offsetHeight } = place("cards");
  const right = offsetHeight > 0 ? offsetLeft + offsetWidth : 0;
  const heads = document.getElementById("pane-heads")?.offsetHeight ?? 0;
  // Where a card takes most of a narrow picture, or would push aside both of two, the scene stays behind it.
  const left = heads === 0 && right < 0.6 * width ? right : 0;
  stage.style.setProperty("--covered", `${bottom}px`);
  stage.style.setProperty("--covered-left", `${left}px`);
  stage.style.setProperty("--heads", `${heads}px`);
  return { left, top: 48 + heads, bottom };
}
