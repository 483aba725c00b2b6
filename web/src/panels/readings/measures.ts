import type { Frame } from "../../gen/phrenic/v1/frames_pb";
import { make, section } from "../../dom/elements";

/** Units that people use, by the one on the wire. */
const familiar: Record<string, [name: string, factor: number]> = {
  m: ["mm", 1000],
  "m^3": ["l", 1000],
  "m^3/s": ["l/s", 1000],
};

/** The unit that people use for one of the wire, and how many of it that one is. */
export function familiarUnit(unit: string): [name: string, factor: number] {
  return familiar[unit] ?? [unit, 1];
}

/** Four significant digits in the unit that people use: "2.513 l". */
export function readingText(value: number, unit: string): string {
  const [name, factor] = familiarUnit(unit);
  return `${Number((factor * value).toPrecision(4))} ${name}`;
}

/** What the scene measures, one line each. */
export class Measures {
  readonly element: HTMLElement;
  private readonly rows = make("tbody");

  constructor() {
    this.element = section("Measures", true, make("table", { className: "probes" }, this.rows));
    this.element.hidden = true;
  }

  show(frame: Frame | undefined): void {
    const measures = frame?.measures ?? [];
    this.element.hidden = measures.length === 0;
    while (this.rows.children.length > measures.length) this.rows.lastElementChild?.remove();
    measures.forEach(({ name, value, unit }, i) => {
      const row = this.rows.children[i] ?? this.addRow();
      [name, readingText(value, unit)].forEach((text, k) => {
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
