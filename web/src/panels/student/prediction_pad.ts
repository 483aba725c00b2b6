import { make } from "../../dom/elements";
import type { PredictionSubject } from "../../graphs/student_graphs";
import { Prediction } from "../../graphs/prediction";
import { breathLengthOf } from "../../parameters/effort";
import type { SessionController } from "../../session/session_controller";
import type { TimeSeries } from "../../state/time_series";
import { fixed, t } from "../../language/translate";

/** What a prediction is about. */
export interface PredictionSource {
  controller: SessionController;
  history: TimeSeries;
  /** What can be predicted; empty for a scene without lungs. */
  subjects(): PredictionSubject[];
  /** Resolves when the samples up to now are in the history. */
  catchUp(): Promise<void>;
}

/** Size of the drawing in its own units. */
const [width, height] = [320, 150];
/** The span of the values that fit the drawing [simulated s]. */
const recent = 8;

/** Receives the mean distance of a prediction from the breath, in the unit of its subject. */
export type OnPredicted = (distance: number, subject: PredictionSubject) => void;

/**
 * Predict, then play: records the course that the user predicts for a measure over the next breath, plays the breath,
 * and shows both curves and their mean distance.
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
  private readonly kinds = make("div", { className: "causes kinds", role: "group", ariaLabel: t("What to predict") });
  /** The measure that is predicted; the first of the subjects before one is chosen. */
  private measure = "";
  private asked: OnPredicted | undefined;
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
    this.svg.append(this.drawn, this.seen);
    this.svg.addEventListener("pointerdown", (event) => this.onPointer(event, true));
    this.svg.addEventListener("pointermove", (event) => event.buttons === 1 && this.onPointer(event, false));
    this.svg.addEventListener("keydown", (event) => this.onKey(event));
    this.begin.onclick = () => this.predict(this.subject?.measure ?? "");
    this.play.onclick = () => void this.see();
    this.element.append(this.kinds, this.begin, this.svg, this.words, this.play);
    this.show("idle");
  }

  /** Shows how far the breath has come; called several times a second. */
  draw(): void {
    const { prediction } = this;
    const { history } = this.source;
    const { subject } = this;
    if (this.phase === "idle" || this.phase === "done") this.showKinds();
    if (this.phase !== "playing" || prediction === undefined || subject === undefined) return;
    const now = history.times.at(-1) ?? 0;
    if (now < prediction.start) return this.show("idle"); // the session was reset
    const first = history.indexAt(prediction.start);
    const times = history.times.slice(first).filter((time) => time <= prediction.end);
    const values = history.series.get(subject.key)?.slice(first) ?? [];
    this.seen.setAttribute("points", times.map((time, i) => this.pixel(prediction, time, values[i])).join(" "));
    if (now >= prediction.end) this.tell(prediction.distance(history, subject.key), subject);
  }

  /** Begins a prediction of a measure; calls `done` when it was played. Returns false if the scene does not show it. */
  predict(measure: string, done?: OnPredicted): boolean {
    if (!this.source.subjects().some((each) => each.measure === measure)) return false;
    [this.measure, this.asked] = [measure, done];
    void this.start();
    return true;
  }

  /** Ends a prediction whose breath is played: a part of it is missing. */
  interrupt(): void {
    if (this.phase !== "playing") return;
    this.show("idle");
    this.words.textContent = t("A part of the breath is missing: predict again.");
  }

  private get subject(): PredictionSubject | undefined {
    const subjects = this.source.subjects();
    return subjects.find(({ measure }) => measure === this.measure) ?? subjects.at(0);
  }

  private async start(): Promise<void> {
    const { controller, history, catchUp } = this.source;
    const { subject } = this;
    if (!(await controller.pause())) return this.refuse("idle");
    await catchUp();
    if (subject === undefined) return;
    const values = history.series.get(subject.key) ?? [];
    const [time, value] = [history.times.at(-1), values.at(-1)];
    if (time === undefined || value === undefined) return;
    const shown = values.slice(history.indexAt(time - recent));
    const { factor, below, above } = subject;
    this.range = [Math.min(...shown) - below / factor, Math.max(...shown) + above / factor];
    const label = t("{0}, as you expect it; left and right choose a time, up and down the value", titleOf(subject));
    this.svg.setAttribute("aria-label", label);
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
    const { controller } = this.source;
    if (!(await controller.play(controller.session.value?.speed || 1))) this.refuse("drawing");
  }

  /** The server did not pause or play the session. */
  private refuse(phase: PredictionPad["phase"]): void {
    this.show(phase);
    this.words.textContent = this.source.controller.notice.value;
  }

  private get breathLength(): number {
    return breathLengthOf(this.source.controller.session.value?.parameters);
  }

  private tell(distance: number, subject: PredictionSubject): void {
    this.show("done");
    const { unit, factor, digits } = subject;
    const apart = fixed(factor * distance, digits);
    this.words.textContent = t(
      "Dashed: your curve. Solid: the breath. On average they are {0} {1} apart.",
      apart,
      unit,
    );
    const { asked } = this;
    this.asked = undefined;
    asked?.(Number((factor * distance).toFixed(digits)), subject);
  }

  /** Buttons of what can be predicted, if there is a choice. */
  private showKinds(): void {
    const [subjects, chosen] = [this.source.subjects(), this.subject?.measure];
    const key = subjects.map(({ measure }) => `${measure} ${measure === chosen}`).join();
    if (key === this.kinds.dataset.shown) return;
    this.kinds.dataset.shown = key;
    this.kinds.hidden = subjects.length < 2;
    const buttons = subjects.map((subject) => {
      const { measure } = subject;
      const onclick = () => {
        this.measure = measure;
        this.show("idle");
        this.kinds.querySelector<HTMLElement>("[aria-pressed=true]")?.focus();
      };
      return make("button", { type: "button", ariaPressed: String(measure === chosen), onclick }, titleOf(subject));
    });
    this.kinds.replaceChildren(...buttons);
  }

  private show(phase: PredictionPad["phase"]): void {
    this.phase = phase;
    this.svg.toggleAttribute("hidden", phase === "idle");
    this.kinds.hidden = phase === "drawing" || phase === "playing" || this.source.subjects().length < 2;
    if (phase === "idle") this.showKinds();
    this.play.hidden = phase !== "drawing";
    this.begin.textContent = phase === "idle" ? t("Predict the next breath") : t("Predict again");
    const words = {
      idle: "",
      drawing: t(hint, titleOf(this.subject)),
      playing: t("The breath is played …"),
      done: "",
    };
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
    } else
      prediction.line({ point: this.cursor, value }, { point: this.cursor, value: value + (up ?? 0) * this.nudge });
    this.drawCurve();
  }

  private get nudge(): number {
    const { subject } = this;
    return subject === undefined ? 0 : subject.nudge / subject.factor;
  }

  private drawCurve(): void {
    const { prediction, cursor, subject } = this;
    if (prediction === undefined || subject === undefined) return;
    const { unit, factor, digits } = subject;
    const { values } = prediction;
    const corners = values.map((value, i) => this.pixel(prediction, prediction.timeOf(i), value));
    this.drawn.setAttribute("points", corners.join(" "));
    const [low, high] = this.range.map((each) => (factor * each).toFixed(digits));
    const seconds = fixed(prediction.timeOf(cursor) - prediction.start, 1);
    const text = t("after {0} s: {1} {2}", seconds, fixed(factor * values[cursor], digits), unit);
    for (const [name, value] of [
      ["valuemin", low],
      ["valuemax", high],
      ["valuenow", (factor * values[cursor]).toFixed(digits)],
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
  "{0}: draw it over one breath, with the mouse, a finger or the arrow keys. Choose another breath first, if you like.";

function polyline(className: string): SVGPolylineElement {
  const line = document.createElementNS("http://www.w3.org/2000/svg", "polyline");
  line.setAttribute("class", className);
  return line;
}

function titleOf(subject: PredictionSubject | undefined): string {
  const title = t(subject?.title ?? "");
  return title.charAt(0).toUpperCase() + title.slice(1);
}
