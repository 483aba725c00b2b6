import { make } from "../../dom/elements";
import { Prediction } from "../../graphs/prediction";
import { breathLengthOf } from "../../parameters/effort";
import type { SessionController } from "../../session/session_controller";
import type { TimeSeries } from "../../state/time_series";
import { fixed, t } from "../../language/translate";

/** What a prediction is about. */
export interface PredictionSource {
  controller: SessionController;
  history: TimeSeries;
  /** Key of the lung volume in the history; undefined for a scene without one. */
  key(): string | undefined;
  /** Resolves when the samples up to now are in the history. */
  catchUp(): Promise<void>;
}

/** Size of the drawing in its own units. */
const [width, height] = [320, 150];
/** Room below and above the volumes of the last breaths [m^3]. */
const [below, above] = [0.0005, 0.001];
/** What an arrow key changes [m^3]. */
const nudge = 0.00005;
/** The span of the volumes that fit the drawing [simulated s]. */
const recent = 8;

/**
 * Predict, then play: records the user's predicted lung volume over the next breath, plays the breath, and shows both
 * curves and their mean distance.
 */
export class PredictionPad {
  readonly element = make("section", { id: "prediction", ariaLabel: t("Predict the next breath") });
  private readonly svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  private readonly drawn = polyline("drawn");
  private readonly seen = polyline("seen");
  private readonly words = make("p", { id: "prediction-words" });
  private readonly begin = make("button", { type: "button", id: "predict" }, t("Predict the next breath"));
  private readonly play = make(
    "button",
    { type: "button", id: "predict-play", className: "primary" },
    t("Play and see"),
  );
  private prediction: Prediction | undefined;
  private range: [low: number, high: number] = [0, 1];
  private cursor = 0;
  private phase: "idle" | "drawing" | "playing" | "done" = "idle";

  constructor(private readonly source: PredictionSource) {
    this.words.setAttribute("role", "status");
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.svg.setAttribute("preserveAspectRatio", "none");
    this.svg.setAttribute("role", "slider");
    this.svg.setAttribute("tabindex", "0");
    this.svg.setAttribute(
      "aria-label",
      t("Air in the lungs that you expect; left and right choose a time, up and down the air"),
    );
    this.svg.append(this.drawn, this.seen);
    this.svg.addEventListener("pointerdown", (event) => this.onPointer(event, true));
    this.svg.addEventListener("pointermove", (event) => event.buttons === 1 && this.onPointer(event, false));
    this.svg.addEventListener("keydown", (event) => this.onKey(event));
    this.begin.onclick = () => void this.start();
    this.play.onclick = () => void this.see();
    this.element.append(this.begin, this.svg, this.words, this.play);
    this.show("idle");
  }

  /** Shows how far the breath has come; called several times a second. */
  draw(): void {
    const { prediction } = this;
    const { history, key } = this.source;
    const name = key();
    if (this.phase !== "playing" || prediction === undefined || name === undefined) return;
    const now = history.times.at(-1) ?? 0;
    if (now < prediction.start) return this.show("idle"); // the session was reset
    const first = history.indexAt(prediction.start);
    const times = history.times.slice(first).filter((time) => time <= prediction.end);
    const values = history.series.get(name)?.slice(first) ?? [];
    this.seen.setAttribute("points", times.map((time, i) => this.pixel(prediction, time, values[i])).join(" "));
    if (now >= prediction.end) this.tell(prediction.distance(history, name));
  }

  private async start(): Promise<void> {
    const { controller, history, key, catchUp } = this.source;
    await controller.pause();
    await catchUp();
    const values = history.series.get(key() ?? "") ?? [];
    const [time, value] = [history.times.at(-1), values.at(-1)];
    if (time === undefined || value === undefined) return;
    const shown = values.slice(history.indexAt(time - recent));
    this.range = [Math.min(...shown) - below, Math.max(...shown) + above];
    this.prediction = new Prediction(time, this.breathLength, value);
    this.cursor = 0;
    this.seen.setAttribute("points", "");
    this.show("drawing");
    this.drawCurve();
    this.svg.focus();
  }

  private async see(): Promise<void> {
    // Another breath may have been chosen since.
    this.prediction = this.prediction?.over(this.breathLength);
    this.drawCurve();
    this.show("playing");
    await this.source.controller.play(this.source.controller.session.value?.speed || 1);
  }

  private get breathLength(): number {
    return breathLengthOf(this.source.controller.session.value?.parameters);
  }

  private tell(distance: number): void {
    this.show("done");
    const litres = fixed(1000 * distance, 2);
    this.words.textContent = t("Dashed: your curve. Solid: the breath. On average they are {0} l apart.", litres);
  }

  private show(phase: PredictionPad["phase"]): void {
    this.phase = phase;
    this.svg.toggleAttribute("hidden", phase === "idle");
    this.play.hidden = phase !== "drawing";
    this.begin.textContent = phase === "idle" ? t("Predict the next breath") : t("Predict again");
    const words = { idle: "", drawing: t(hint), playing: t("The breath is played …"), done: "" };
    this.words.textContent = words[phase];
  }

  private onPointer(event: PointerEvent, first: boolean): void {
    const { prediction } = this;
    if (this.phase !== "drawing" || prediction === undefined) return;
    if (first) this.svg.setPointerCapture(event.pointerId);
    event.preventDefault();
    const box = this.svg.getBoundingClientRect();
    const point = prediction.pointAt((event.clientX - box.left) / box.width);
    const [low, high] = this.range;
    const value = high - ((event.clientY - box.top) / box.height) * (high - low);
    const from = first ? { point, value } : { point: this.cursor, value: prediction.values[this.cursor] };
    prediction.line(from, { point, value });
    this.cursor = point;
    this.drawCurve();
  }

  private onKey(event: KeyboardEvent): void {
    const { prediction } = this;
    const across = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    const up = { ArrowDown: -1, ArrowUp: 1 }[event.key];
    if (this.phase !== "drawing" || prediction === undefined || (across ?? up) === undefined) return;
    event.preventDefault();
    const value = prediction.values[this.cursor];
    if (across !== undefined) {
      // What follows keeps the height that was chosen last.
      const next = Math.min(prediction.values.length - 1, Math.max(0, this.cursor + across));
      if (across > 0) prediction.line({ point: this.cursor, value }, { point: next, value });
      this.cursor = next;
    } else prediction.line({ point: this.cursor, value }, { point: this.cursor, value: value + (up ?? 0) * nudge });
    this.drawCurve();
  }

  private drawCurve(): void {
    const { prediction, cursor } = this;
    if (prediction === undefined) return;
    const { values } = prediction;
    const corners = values.map((value, i) => this.pixel(prediction, prediction.timeOf(i), value));
    this.drawn.setAttribute("points", corners.join(" "));
    const [low, high] = this.range.map((each) => (1000 * each).toFixed(2));
    const seconds = fixed(prediction.timeOf(cursor) - prediction.start, 1);
    const text = t("after {0} s: {1} l", seconds, fixed(1000 * values[cursor], 2));
    for (const [name, value] of [
      ["valuemin", low],
      ["valuemax", high],
      ["valuenow", (1000 * values[cursor]).toFixed(2)],
      ["valuetext", text],
    ])
      this.svg.setAttribute(`aria-${name}`, value);
  }

  private pixel({ start, length }: Prediction, time: number, value: number): string {
    const [low, high] = this.range;
    const x = (width * (time - start)) / length;
    return `${x.toFixed(1)},${((height * (high - value)) / (high - low)).toFixed(1)}`;
  }
}

const hint =
  "Draw the air in the lungs over one breath: with the mouse, a finger or the arrow keys. Choose another breath first, if you like.";

function polyline(className: string): SVGPolylineElement {
  const line = document.createElementNS("http://www.w3.org/2000/svg", "polyline");
  line.setAttribute("class", className);
  return line;
}
