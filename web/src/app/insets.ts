import { elementById } from "../dom/elements";
import type { Insets } from "../viewer/camera_rig";
import { nameColumn } from "../viewer/names";

/**
 * Returns the parts of the stage that view buttons, headers, dock and cards cover [CSS pixels], and passes them to the
 * style sheet as custom properties. `named` leaves room for the names beside the scene.
 */
export function stageInsets(named: boolean): Insets {
  const stage = elementById("stage");
  const width = elementById("view").clientWidth;
  const bottom = stage.clientHeight - elementById("dock").offsetTop;
  const { offsetLeft, offsetWidth, offsetHeight } = elementById("cards");
  const right = offsetHeight > 0 ? offsetLeft + offsetWidth : 0;
  const heads = document.getElementById("view-headers")?.offsetHeight ?? 0;
  // A card that takes most of a narrow stage, or that lies over two views, does not shift the scene.
  const left = heads === 0 && right < 0.6 * width ? right : 0;
  stage.style.setProperty("--covered", `${bottom}px`);
  stage.style.setProperty("--covered-left", `${left}px`);
  stage.style.setProperty("--heads", `${heads}px`);
  // A short bar lies beside the narrow top of the scene.
  const bar = elementById("views");
  const top = bar.offsetLeft + bar.offsetWidth < 0.45 * width ? 14 : bar.offsetTop + bar.offsetHeight + 4;
  return { left, top: top + heads, bottom, sides: named ? nameColumn(width - left) : 0 };
}
