import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { GraphSpec } from "./catalogue";
import { curveColor } from "./colors";
import type { Backdrop, Point } from "./references";
import { type GraphData, SteadyRange, type TimeSpan } from "./window";
import { decimal } from "../language/translate";

/** Events of a plot. */
export interface PlotEvents {
  /** A time span was selected by dragging. */
  zoom(span: TimeSpan): void;
  /** A double click: shows live data again. */
  resume(): void;
  /** Index of the data point under the pointer, shared by all plots over time. */
  cursor(place: number | undefined): void;
}

/** Returns a colour of the style sheet as it is now. */
const styled = (name: string) => () => getComputedStyle(document.documentElement).getPropertyValue(name);
const faint = styled("--faint");
const grid = { stroke: styled("--line"), width: 1 };
const font = "11px system-ui, sans-serif";
/** Heights of a graph; of one whose areas are to be seen [CSS pixels]. */
const plotHeight = 104;
const areaHeight = 190;

/** One graph, drawn by uPlot. */
export class Plot {
  readonly element = document.createElement("div");
  private readonly plot: uPlot;
  private data: GraphData = { times: [], abscissa: undefined, curves: [] };
  private span: TimeSpan = { start: 0, end: 1 };
  private backdrop: Backdrop | undefined;
  private readonly ranges = { x: new SteadyRange(), y: new SteadyRange() };
  /** The line at the marked time. */
  private now: HTMLElement | undefined;

  constructor(
    private readonly spec: GraphSpec,
    private readonly events: PlotEvents,
  ) {
    this.element.className = "plot";
    this.plot = new uPlot(spec.abscissa === undefined ? this.overTime() : this.loop(), [[]], this.element);
    this.plot.over.addEventListener("dblclick", () => events.resume());
    new ResizeObserver(() => this.fit()).observe(this.element);
  }

  /** Draws the data within the span, and what is behind it. */
  show(data: GraphData, span: TimeSpan, backdrop?: Backdrop): void {
    [this.data, this.span, this.backdrop] = [data, span, backdrop];
    if (data.abscissa === undefined) this.plot.setData([data.times, ...data.curves], true);
    else this.plot.setData([[0, 1]], true);
  }

  /** Marks a time of a graph over time with a line [s]. */
  mark(time: number): void {
    if (this.spec.abscissa !== undefined) return;
    if (this.now === undefined) {
      this.now = document.createElement("div");
      this.now.className = "now";
      this.plot.over.append(this.now);
    }
    this.now.style.left = `${this.plot.valToPos(time, "x")}px`;
  }

  private get height(): number {
    return this.spec.id === "campbell" ? areaHeight : plotHeight;
  }

  private fit(): void {
    const width = this.element.clientWidth;
    if (width > 0 && width !== this.plot.width) this.plot.setSize({ width, height: this.height });
  }

  private frame(
    x: uPlot.Scale,
    y: uPlot.Scale,
  ): Pick<uPlot.Options, "width" | "height" | "legend" | "axes" | "scales"> {
    // Ticks have few digits; uPlot would write them in the browser's language.
    const values = (_: uPlot, ticks: number[]) => ticks.map((each) => decimal(String(Number(each.toPrecision(6)))));
    const axis = { stroke: faint, grid, ticks: { show: false }, font, gap: 4 };
    return {
      width: 300,
      height: this.height,
      legend: { show: false },
      scales: { x: { ...x, time: false }, y },
      axes: [
        { ...axis, size: 20, space: 46, values },
        { ...axis, size: 44, space: 24, values },
      ],
    };
  }

  private overTime(): uPlot.Options {
    const { curves } = this.spec;
    return {
      ...this.frame({ range: () => [this.span.start, this.span.end] }, { range: () => this.valueRange() }),
      series: [
        {},
        ...curves.map(({ order, dashed }, i) => ({
          stroke: () => curveColor(order ?? i),
          width: 1.6,
          dash: dashed === true ? [5, 4] : [],
          points: { show: false },
        })),
      ],
      cursor: { y: false, sync: { key: "phrenic" }, drag: { x: true, setScale: false }, points: { size: 6 } },
      hooks: {
        drawAxes: [(plot) => this.drawBackdrop(plot)],
        setSelect: [(plot) => this.select(plot)],
        setCursor: [(plot) => this.events.cursor(plot.cursor.idx ?? undefined)],
      },
    };
  }

  private select(plot: uPlot): void {
    const { left, width } = plot.select;
    if (width < 4) return;
    const [start, end] = [plot.posToVal(left, "x"), plot.posToVal(left + width, "x")];
    plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    this.events.zoom({ start, end });
  }

  /** uPlot draws curves only from left to right, so a loop is drawn by hand into its axes. */
  private loop(): uPlot.Options {
    return {
      ...this.frame(
        {
          range: () =>
            this.ranges.x.of(
              [this.data.abscissa ?? [], ...this.lineValues(0)],
              minimumRange(this.spec.abscissa?.unit ?? ""),
            ),
        },
        { range: () => this.valueRange() },
      ),
      series: [{}],
      cursor: { show: false },
      hooks: { drawAxes: [(plot) => this.drawBackdrop(plot)], draw: [(plot) => this.drawLoop(plot)] },
    };
  }

  /** The range of the vertical axis: of the data, and of what is behind it. */
  private valueRange(): [low: number, high: number] {
    const bands = (this.backdrop?.bands ?? []).map(({ low, high }) => [low, high]);
    return this.ranges.y.of([...this.data.curves, ...bands, ...this.lineValues(1)], minimumRange(this.spec.unit));
  }

  private lineValues(axis: 0 | 1): number[][] {
    return (this.backdrop?.lines ?? []).map(({ points }) => points.map((point) => point[axis]));
  }

  private drawBackdrop({ ctx, valToPos, bbox }: uPlot): void {
    const { backdrop } = this;
    if (backdrop === undefined) return;
    const trace = (points: Point[]) => {
      ctx.beginPath();
      for (const [x, y] of points) ctx.lineTo(valToPos(x, "x", true), valToPos(y, "y", true));
    };
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.globalAlpha = 0.2;
    ctx.fillStyle = curveColor(3);
    for (const { low, high } of backdrop.bands) {
      const [top, bottom] = [high, low].map((each) => valToPos(each, "y", true));
      ctx.fillRect(bbox.left, top, bbox.width, bottom - top);
    }
    for (const { points, order } of backdrop.areas) {
      ctx.fillStyle = curveColor(order);
      trace(points);
      ctx.fill();
    }
    ctx.globalAlpha = 0.9;
    ctx.lineWidth = 1.4 * devicePixelRatio;
    for (const { points, order, dashed } of backdrop.lines) {
      ctx.strokeStyle = curveColor(order);
      ctx.setLineDash(dashed ? [5 * devicePixelRatio, 4 * devicePixelRatio] : []);
      trace(points);
      ctx.stroke();
    }
    ctx.restore();
  }

  /** Draws the loop with older parts fading and a dot at the current point. */
  private drawLoop({ ctx, valToPos }: uPlot): void {
    const { abscissa = [], curves } = this.data;
    const pixelAt = (i: number): [number, number] => [
      valToPos(abscissa[i], "x", true),
      valToPos(curves[0][i], "y", true),
    ];
    if (abscissa.length < 2) return;
    const parts = 24;
    ctx.save();
    ctx.strokeStyle = ctx.fillStyle = curveColor(0);
    ctx.lineWidth = 1.6 * devicePixelRatio;
    for (let part = 0; part < parts; part++) {
      ctx.globalAlpha = 0.15 + (0.85 * (part + 1)) / parts;
      ctx.beginPath();
      const [first, last] = [part, part + 1].map((k) => Math.floor((k * (abscissa.length - 1)) / parts));
      for (let i = first; i <= last; i++) ctx.lineTo(...pixelAt(i));
      ctx.stroke();
    }
    ctx.beginPath();
    ctx.arc(...pixelAt(abscissa.length - 1), 3.5 * devicePixelRatio, 0, 7);
    ctx.fill();
    ctx.restore();
  }
}

/** Smallest vertical range of a graph: smaller changes are rounding errors. */
function minimumRange(unit: string): number {
  return { l: 0.01, "l/s": 0.01, Pa: 1, mm: 0.1, "cmH₂O": 0.1, "": 0.1 }[unit] ?? 1e-9;
}
