import { make } from "../../dom/elements";
import { curveColor } from "../../graphs/colors";
import { pointLabel, pointOf, type TissuePoint, type TissuePoints } from "../../lungs/tissue_points";
import type { PointReading } from "../../gen/phrenic/v1/tissue_pb";
import { fixed, t } from "../../language/translate";

const heads = ["At rest, mm", "mm", "Volume %", "Strain %"];

/** A card with the points inside the lungs that this viewer follows, and a field for another one. */
export class TissueCard {
  readonly element: HTMLElement;
  private readonly rows = make("tbody");
  private readonly note = make("p", { className: "faint" });

  constructor(private readonly points: TissuePoints) {
    const field = make("input", {
      type: "text",
      id: "tissue-point",
      placeholder: "x, y, z",
      ariaLabel: t("Place at rest inside a lung: left, back, up [mm]"),
    });
    const follow = make("button", { type: "button", id: "tissue-follow" }, t("Follow"));
    const form = make("form", { className: "row" }, field, follow);
    follow.type = "submit";
    form.onsubmit = (event) => {
      event.preventDefault();
      const point = pointOf(field.value);
      this.note.textContent = point === undefined ? t("Three numbers are needed, such as 60, 20, 250.") : t(help);
      if (point === undefined) return;
      points.add(point);
      field.value = "";
    };
    this.note.textContent = t(help);
    this.note.setAttribute("role", "status");
    const cells = [...heads.map((text) => make("th", { scope: "col" }, t(text))), make("td")];
    const table = make("table", { className: "figures" }, make("thead", {}, make("tr", {}, ...cells)), this.rows);
    const title = make("h2", {}, t("Inside the lungs"));
    this.element = make("section", { id: "tissue", className: "card", hidden: true }, title, table, form, this.note);
    this.element.ariaLabel = t("Points inside the lungs");
    points.all.subscribe((all) => {
      table.hidden = all.length === 0;
      this.rows.replaceChildren(...all.map((point, i) => this.row(point, i)));
    });
    points.readings.subscribe((readings) => this.show(readings));
  }

  private row(point: TissuePoint, order: number): HTMLTableRowElement {
    const swatch = make("span", { className: "swatch" });
    swatch.style.backgroundColor = curveColor(order);
    const name = pointLabel(point);
    const leave = make(
      "button",
      { type: "button", className: "small", ariaLabel: t("Stop following {0}", name) },
      t("Stop"),
    );
    leave.onclick = () => this.points.remove(point);
    const head = make("th", { scope: "row" }, make("span", { className: "key" }, swatch, name));
    return make("tr", {}, head, make("td"), make("td"), make("td"), make("td", {}, leave));
  }

  private show(readings: readonly (PointReading | undefined)[]): void {
    readings.forEach((reading, i) => {
      textsOf(reading).forEach((text, k) => {
        const cell = this.rows.rows[i]?.cells[k + 1];
        if (cell !== undefined && cell.textContent !== text) cell.textContent = text;
      });
    });
  }
}

const help = "Click on a cut lung, or enter a place at rest: left, back, up.";

function textsOf(reading: PointReading | undefined): string[] {
  if (reading === undefined) return [t("no lung"), "", ""];
  const { dx, dy, dz, ventilation, strain } = reading;
  return [1000 * Math.hypot(dx, dy, dz), 100 * ventilation, 100 * strain].map((each) =>
    fixed(each, 1).replace("-", "−"),
  );
}
