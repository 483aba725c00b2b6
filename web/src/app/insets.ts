import { elementById } from "../dom/elements";
import type { Insets } from "../viewer/camera_rig";

/** How much of the picture lies under view buttons, heads, dock and cards [CSS pixels]; the style sheet hears of it too. */
export function stageInsets(): Insets {
  const stage = elementById("stage");
  const width = elementById("view").clientWidth;
  const bottom = stage.clientHeight - elementById("dock").offsetTop;
  const { offsetLeft, offsetWidth, offsetHeight } = elementById("cards");
  const right = offsetHeight > 0 ? offsetLeft + offsetWidth : 0;
  const heads = document.getElementById("pane-heads")?.offsetHeight ?? 0;
  // Where a card takes most of a narrow picture, or would push aside both of two, the scene stays behind it.
  const left = heads === 0 && right < 0.6 * width ? right : 0;
  stage.style.setProperty("--covered", `${bottom}px`);
  stage.style.setProperty("--covered-left", `${left}px`);
  stage.style.setProperty("--heads", `${heads}px`);
  return { left, top: 48 + heads, bottom };
}
