import { download } from "../../dom/download";
import { make } from "../../dom/elements";
import type { Curve, GraphSpec } from "../../graphs/catalogue";
import { curveColor } from "../../graphs/colors";
import { toCsv, toSvg } from "../../graphs/files";
import { Plot, type PlotEvents } from "../../graphs/plot";
import type { ShownReferences } from "../../graphs/references";
import { graphData, type GraphData, type TimeSpan } from "../../graphs/window";
import type { TimeSeries } from "../../state/time_series";
import { decimal, t } from "../../language/translate";

/** One graph with its title, legend, current values, and buttons to save it. */
export class GraphTile {
  readonly element: HTMLElement;
  private readonly plot: Plot;
  private readonly readings: HTMLElement[];
  private readonly swatches: HTMLElement[];
  private readonly note = make("p", { className: "faint note", hidden: true });
  private data: GraphData = { times: [], abscissa: undefined, curves: [] };

  constructor(
    private readonly spec: GraphSpec,
    private readonly history: TimeSeries,
    private readonly fileName: () => string,
    events: PlotEvents,
    private readonly references: () => ShownReferences | undefined = () => undefined,
  ) {
    this.plot = new Plot(spec, events);
    this.readings = spec.curves.map(() => make("b"));
    this.swatches = spec.curves.map(({ dashed }) =>
      make("span", { className: dashed === true ? "swatch dashed" : "swatch" }),
    );
    const keys = spec.curves.map((curve, i) => this.key(curve, i));
    const save = ["SVG", "CSV"].map((kind) => this.saveButton(kind as "SVG" | "CSV"));
    // A single curve needs no legend.
    const alone = keys.length === 1;
    const title = make("h3", { title: t(spec.help ?? "") }, this.title(), ...(alone ? this.readings : []));
    const head = make("header", {}, title, make("div", { className: "save" }, ...save));
    this.element = make("section", { className: "tile", ariaLabel: t(spec.title) }, head, this.plot.element);
    if (!alone) this.element.append(make("div", { className: "keys" }, ...keys));
    this.element.append(this.note);
    this.element.dataset.graph = spec.id;
  }

  /** Shows a time span with the values at index `place`, or at its end. */
  show(span: TimeSpan, place: number | undefined): void {
    this.data = graphData(this.spec, this.history, span);
    const references = this.references();
    const backdrop = references?.backdropOf(this.spec, this.data, references);
    this.plot.show(this.data, span, backdrop);
    this.note.hidden = backdrop === undefined;
    if (backdrop !== undefined && this.note.textContent !== backdrop.words) this.note.textContent = backdrop.words;
    // The colours follow the page's, which may have changed.
    this.spec.curves.forEach(({ order }, i) => (this.swatches[i].style.color = curveColor(order ?? i)));
    this.showValues(place);
  }

  /** Marks a time [s], and shows the values at an index of the data. */
  mark(time: number, place: number): void {
    this.plot.mark(time);
    this.showValues(place);
  }

  /** Shows the values at an index of the data, or the last ones if undefined. */
  showValues(place: number | undefined): void {
    this.data.curves.forEach((values, i) => {
      const value = values[place ?? values.length - 1] as number | undefined;
      const words = value === undefined ? "" : formatReading(value);
      if (this.readings[i].textContent !== words) this.readings[i].textContent = words;
    });
  }

  private title(): string {
    const { unit, abscissa } = this.spec;
    const title = t(this.spec.title);
    if (abscissa !== undefined) return `${title} [${unit}, ${abscissa.unit}]`;
    return unit === "" ? title : `${title} [${unit}]`;
  }

  private key({ name }: Curve, place: number): HTMLElement {
    return make("span", { className: "key" }, this.swatches[place], make("span", {}, t(name)), this.readings[place]);
  }

  private saveButton(kind: "SVG" | "CSV"): HTMLElement {
    const save = () => {
      const content = kind === "SVG" ? toSvg(this.spec, this.data) : toCsv(this.spec, this.data);
      const type = kind === "SVG" ? "image/svg+xml" : "text/csv";
      const file = `${this.fileName()}-${this.spec.id.replaceAll(/[^a-z0-9]+/g, "-")}.${kind.toLowerCase()}`;
      download(file, new Blob([content], { type }));
    };
    const title = t("Save {0} as {1}", t(this.spec.title), kind);
    return make("button", { type: "button", className: "small", title, ariaLabel: title, onclick: save }, kind);
  }
}

/** Formats three significant digits, with a minus sign only for numbers that are not zero. */
function formatReading(value: number): string {
  const size = Math.abs(value);
  const text = value.toFixed(size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3);
  return decimal(Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−"));
}
