import {
  type Measurement,
  type Measurements,
  type MeasureTool,
  pointsOf,
  quantityText,
} from "../../appearance/measurements";
import { button, make } from "../../dom/elements";
import { section } from "../../dom/rows";
import type { FrameArrays } from "../../geometry/bodies";
import { curveColor } from "../../graphs/colors";
import { t } from "../../language/translate";

const tools: [MeasureTool, string, string][] = [
  ["distance", "Distance", "Between two points on surfaces (M)"],
  ["angle", "Angle", "At the second of three points on surfaces"],
  ["surface", "Area, volume", "Surface of the structure at a point, and its volume if it is closed"],
];

/** The tools that measure, and the list of what is measured. */
export class MeasurePanel {
  readonly element: HTMLElement;
  /** Says over the stage what the next click does. */
  readonly hint = make("div", { id: "measure-hint", hidden: true });
  private readonly next = make("output");
  private readonly rows = make("tbody");
  private readonly clear: HTMLButtonElement;

  constructor(private readonly measurements: Measurements) {
    const bar = make("div", { className: "measure-tools", role: "group", ariaLabel: t("Measure") }, ...this.buttons());
    this.clear = button(t("Remove all measurements (Escape)"), () => measurements.clear(), t("Remove all"));
    this.clear.id = "measure-clear";
    const table = make("table", { className: "probes measured", ariaLabel: t("Measurements") }, this.rows);
    this.element = section(t("Measure"), true, bar, table, this.clear);
    this.element.id = "measure";
    measurements.all.subscribe((all) => {
      this.rows.replaceChildren(...all.map((each) => this.row(each)));
      this.clear.hidden = table.hidden = all.length === 0;
    });
    const keys = make("p", {}, t("or move the cross with the arrow keys and press Enter"));
    const end = button(t("End measuring (Escape)"), () => measurements.use(undefined), t("End"));
    this.hint.append(make("div", {}, this.next, keys), end);
    const sayNext = () => this.sayNext();
    measurements.tool.subscribe(sayNext);
    measurements.picked.subscribe(sayNext);
  }

  /** Shows the values in a frame. */
  show(arrays: FrameArrays | undefined): void {
    if (arrays === undefined) return;
    this.measurements.all.value.forEach((each, i) => {
      const cell = this.rows.children[i].children[1];
      const text = readingOf(this.measurements, each, arrays).join("\n");
      if (cell.textContent !== text) cell.textContent = text;
    });
  }

  private buttons(): HTMLButtonElement[] {
    const { measurements } = this;
    return tools.map(([tool, label, title]) => {
      const toggle = () => measurements.use(measurements.tool.value === tool ? undefined : tool);
      const element = make(
        "button",
        { type: "button", id: `measure-${tool}`, title: t(title), onclick: toggle },
        t(label),
      );
      measurements.tool.subscribe((active) => (element.ariaPressed = String(active === tool)));
      return element;
    });
  }

  private row({ id, name }: Measurement): HTMLTableRowElement {
    const swatch = make("span", { className: "swatch" });
    swatch.style.backgroundColor = curveColor(id);
    const remove = button(t("Remove the measurement of {0}", name), () => this.measurements.remove(id), "×");
    remove.className = "quiet";
    const head = make("th", { scope: "row" }, swatch, name);
    return make("tr", {}, head, make("td", { className: "reading" }), make("td", {}, remove));
  }

  private sayNext(): void {
    const { tool, picked } = this.measurements;
    this.hint.hidden = tool.value === undefined;
    if (tool.value === undefined) return;
    const count = pointsOf[tool.value];
    const next = tool.value === "surface" ? t("a structure") : t("point {0} of {1}", picked.value.length + 1, count);
    const [, label] = tools.find(([each]) => each === tool.value)!;
    this.next.textContent = t("{0}: click {1}", label, next);
  }
}

/** Returns the values of a measurement as texts. */
export function readingOf(measurements: Measurements, measurement: Measurement, arrays: FrameArrays): string[] {
  return measurements.values(measurement, arrays).map(([what, value]) => quantityText(what, value));
}
