import type { Frame } from "../gen/phrenic/v1/frames_pb";
import { History } from "../history";
import { make } from "./dom";

/** Colours that also differ in lightness, for those who do not tell red from green. */
export const traceColors = ["#ff9b8a", "#7cc7ff", "#ffd166", "#8fe3b0", "#c9a7ff", "#f2f2f2"];
const margin = 6;

/** A strip chart of how far each probe is above its rest [mm], over the last seconds of simulated time. */
export class Trace {
  readonly element = make("canvas", { className: "trace", role: "img", ariaLabel: "Height of the probes over time" });
  private readonly history = new History(12);

  /** Takes in a frame; drawing is left to `draw`. */
  receive(frame: Frame): void {
    this.history.add(
      frame.time,
      frame.probes.map(({ name, dz }) => [name, 1000 * dz]),
    );
  }

  draw(): void {
    const { clientWidth: width, clientHeight: height } = this.element;
    const pen = this.element.getContext("2d");
    if (pen === null || width === 0) return;
    const ratio = Math.min(devicePixelRatio, 2);
    this.fit(Math.round(width * ratio), Math.round(height * ratio));
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    const [low, high] = this.history.range();
    const y = (value: number) => margin + ((high - value) / (high - low || 1)) * (height - 2 * margin);
    this.drawZero(pen, width, y(0));
    const end = this.history.times.at(-1) ?? 0;
    const x = (time: number) => width - ((end - time) / this.history.span) * width;
    [...this.history.series.values()].forEach((values, i) => this.drawSeries(pen, values, i, x, y));
  }

  /** Setting a canvas' size allocates it anew, even where the size stays. */
  private fit(width: number, height: number): void {
    if (this.element.width !== width) this.element.width = width;
    if (this.element.height !== height) this.element.height = height;
  }

  private drawZero(pen: CanvasRenderingContext2D, width: number, y: number): void {
    pen.strokeStyle = "#48535f";
    pen.setLineDash([3, 4]);
    pen.beginPath();
    pen.moveTo(0, y);
    pen.lineTo(width, y);
    pen.stroke();
    pen.setLineDash([]);
  }

  private drawSeries(
    pen: CanvasRenderingContext2D,
    values: number[],
    order: number,
    x: (time: number) => number,
    y: (value: number) => number,
  ): void {
    pen.strokeStyle = traceColors[order % traceColors.length];
    pen.lineWidth = 1.6;
    pen.lineJoin = "round";
    pen.beginPath();
    values.forEach((value, i) => pen.lineTo(x(this.history.times[i]), y(value)));
    pen.stroke();
  }
}
