import type { Frame } from "../gen/phrenic/v1/frames_pb";
import { make, section } from "./dom";
import { Trace, traceColors } from "./trace";

/** Probes: displacement from rest in the patient's directions [mm], now and over the last seconds. */
export class Probes {
  readonly element: HTMLElement;
  private readonly rows = make("tbody");
  private readonly trace = new Trace();

  constructor() {
    const heads = ["Probe", "Left", "Back", "Up"].map((text) => make("th", { scope: "col" }, text));
    const table = make("table", { className: "probes" }, make("thead", {}, make("tr", {}, ...heads)), this.rows);
    const unit = make("p", { className: "faint" }, "Displacement from rest in mm; above, upward over 12 s");
    this.element = section("Probes", true, this.trace.element, table, unit);
    this.element.hidden = true;
  }

  /** Every frame goes into the trace, however seldom it is drawn. */
  receive(frame: Frame): void {
    this.trace.receive(frame);
  }

  show(frame: Frame | undefined): void {
    const probes = frame?.probes ?? [];
    this.element.hidden = probes.length === 0;
    while (this.rows.rows.length > probes.length) this.rows.deleteRow(-1);
    probes.forEach(({ name, dx, dy, dz }, i) => {
      const row = this.rows.rows[i] ?? this.addRow(i);
      [name, ...[dx, dy, dz].map((metres) => (1000 * metres).toFixed(1))].forEach((text, k) => {
        const cell = k === 0 ? row.cells[0].lastElementChild! : row.cells[k];
        if (cell.textContent !== text) cell.textContent = text;
      });
    });
    this.trace.draw();
  }

  private addRow(order: number): HTMLTableRowElement {
    const row = this.rows.insertRow();
    const key = make("span", { className: "swatch" });
    key.style.backgroundColor = traceColors[order % traceColors.length];
    row.append(make("th", { scope: "row" }, key, make("span")), make("td"), make("td"), make("td"));
    return row;
  }
}
