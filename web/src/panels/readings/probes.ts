import { make } from "../../dom/elements";
import { section } from "../../dom/rows";
import type { Frame } from "../../gen/phrenic/v1/frames_pb";
import { fixed, t } from "../../language/translate";

/** The probes' displacements from rest in anatomical directions [mm]. */
export class Probes {
  readonly element: HTMLElement;
  private readonly rows = make("tbody");

  constructor() {
    const heads = ["Probe", "Left", "Back", "Up"].map((text) => make("th", { scope: "col" }, t(text)));
    const table = make("table", { className: "probes" }, make("thead", {}, make("tr", {}, ...heads)), this.rows);
    const unit = make("p", { className: "faint" }, t("Displacement of one vertex each from rest, in mm"));
    this.element = section(t("Probes"), true, table, unit);
    this.element.hidden = true;
  }

  /** Shows the probes of a frame; hides the section if there are none. */
  show(frame: Frame | undefined): void {
    const probes = frame?.probes ?? [];
    this.element.hidden = probes.length === 0;
    while (this.rows.rows.length > probes.length) this.rows.deleteRow(-1);
    probes.forEach(({ name, dx, dy, dz }, i) => {
      const row = this.rows.rows[i] ?? this.addRow();
      [t(name), ...[dx, dy, dz].map((metres) => fixed(1000 * metres, 1))].forEach((text, k) => {
        const cell = row.cells[k];
        if (cell.textContent !== text) cell.textContent = text;
      });
    });
  }

  private addRow(): HTMLTableRowElement {
    const row = this.rows.insertRow();
    row.append(make("th", { scope: "row" }), make("td"), make("td"), make("td"));
    return row;
  }
}
