import { make } from "../../dom/elements";
import type { ViewName } from "../../viewer/named_views";
import type { Viewer } from "../../viewer/viewer";

const views: [ViewName, string][] = [
  ["home", "Home"],
  ["front", "Front"],
  ["left", "Left"],
  ["top", "Top"],
];

/** Buttons for the named views, and the keys that move the camera. */
export function viewBar(viewer: Viewer, canvas: HTMLElement): HTMLElement[] {
  canvas.addEventListener("keydown", (event) => {
    const nudge = nudges[event.key];
    if (nudge === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    viewer.rig.nudge(...nudge);
    event.preventDefault();
  });
  return views.map(([view, label]) => {
    const element = make("button", { type: "button", onclick: () => viewer.goTo(view) }, label);
    element.dataset.view = view;
    return element;
  });
}

const angle = Math.PI / 36;
const nudges: Record<string, [azimuth: number, polar: number, zoom: number]> = {
  ArrowLeft: [-angle, 0, 1],
  ArrowRight: [angle, 0, 1],
  ArrowUp: [0, -angle, 1],
  ArrowDown: [0, angle, 1],
  "+": [0, 0, 1.1],
  "=": [0, 0, 1.1],
  "-": [0, 0, 1 / 1.1],
};
