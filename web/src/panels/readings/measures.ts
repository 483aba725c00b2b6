import { make } from "../../dom/elements";
import { section } from "../../dom/rows";
import type { Frame } from "../../gen/phrenic/v1/frames_pb";
import { displayUnit } from "../../graphs/units";
import { decimal, t } from "../../language/translate";

/** Formats four significant digits in the unit of the user interface: "2.513 l". */
export function readingText(value: number, unit: string): string {
  const [name, factor] = displayUnit(unit);
  return `${decimal(String(Number((factor * value).toPrecision(4))))} ${name}`;
}

/** The scene's measures, one row each. */
export class Measures {
  readonly element: HTMLElement;
  private readonly rows = make("tbody");

  constructor() {
    this.element = section(t("Measures"), true, make("table", { className: "probes" }, this.rows));
    this.element.hidden = true;
  }

  /** Shows the measures of a frame; hides the section if there are none. */
  show(frame: Frame | undefined): void {
    const measures = frame?.measures ?? [];
    this.element.hidden = measures.length === 0;
    while (this.rows.children.length > measures.length) this.rows.lastElementChild?.remove();
    measures.forEach(({ name, value, unit }, i) => {
      const row = this.rows.children[i] ?? this.addRow();
      [t(name), readingText(value, unit)].forEach((text, k) => {
        if (row.children[k].textContent !== text) row.children[k].textContent = text;
      });
    });
  }

  private addRow(): HTMLTableRowElement {
    const row = make("tr", {}, make("th", { scope: "row" }), make("td", { className: "reading" }));
    this.rows.append(row);
    return row;
  }
}
