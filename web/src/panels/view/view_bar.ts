import { make } from "../../dom/elements";
import type { Signal } from "../../state/signal";
import type { Viewpoint } from "../../viewer/viewpoints";
import type { Viewer } from "../../viewer/viewer";
import { t } from "../../language/translate";

const buttons: [name: string, label: string][] = [
  ["home", "Home"],
  ["front", "Front"],
  ["left", "Left"],
  ["top", "Top"],
];

/** Shows a view by its name. */
export type Visit = (name: string) => void;

/** Buttons and a list for the named views, and the keys that move the camera. */
export function viewBar(
  viewer: Viewer,
  canvas: HTMLElement,
  viewpoints: Signal<Viewpoint[]>,
  visit: Visit,
): HTMLElement[] {
  canvas.addEventListener("keydown", (event) => {
    const nudge = nudges[event.key];
    if (nudge === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    viewer.rig.nudge(...nudge);
    event.preventDefault();
  });
  const row = buttons.map(([name, label]) => {
    const element = make("button", { type: "button", onclick: () => visit(name) }, t(label));
    element.dataset.view = name;
    return element;
  });
  return [make("div", { className: "view-buttons" }, ...row), viewList(viewpoints, visit)];
}

/** A list of all views, with the key of each. */
function viewList(viewpoints: Signal<Viewpoint[]>, visit: Visit): HTMLElement {
  const list = make("select", { id: "viewpoints", ariaLabel: t("Views"), title: t("Views and cuts by name") });
  list.onchange = () => {
    visit(list.value);
    list.value = "";
  };
  viewpoints.subscribe((all) => {
    const options = all.map(({ name, label, key }) => make("option", { value: name }, `${t(label)} (${key})`));
    list.replaceChildren(make("option", { value: "", hidden: true }, t("Views")), ...options);
    list.value = "";
  });
  return list;
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
