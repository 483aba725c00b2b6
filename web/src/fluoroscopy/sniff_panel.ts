import { make } from "../dom/elements";
import type { Frame } from "../gen/phrenic/v1/frames_pb";
import { sniffPlot } from "./sniff_plot";
import { domeColors } from "./sniff_plot";
import { type DomeHeights, type SniffResult, SniffTest, sniffWords } from "./sniff_test";
import { svg } from "./svg";
import { t } from "../language/translate";

/** What a sniff test does to the session. */
export interface SniffActions {
  /** Returns why this viewer may not change the session; empty if it may. */
  refusal(): string;
  /** Makes the session sniff, with the nerves and lungs that it has, and plays it. */
  start(): Promise<void>;
  /** Restores the breath before. */
  stop(): Promise<void>;
}

/** The sniff test: a button, both domes over time, and the result in words. */
export class SniffPanel {
  readonly element = make("div", { className: "sniff" });
  private readonly run = make("button", { type: "button", id: "sniff-run", className: "primary" }, t("Sniff test"));
  private readonly back = make(
    "button",
    { type: "button", id: "sniff-back", hidden: true },
    t("Back to the breath before"),
  );
  private readonly words = make("p", { id: "sniff-result", role: "status" });
  private readonly plot = make("div", { className: "sniff-figure", hidden: true });
  private test: SniffTest | undefined;

  /** `shown` is called when a test begins. */
  constructor(
    private readonly actions: SniffActions,
    private readonly shown: () => void,
  ) {
    this.run.title = t("PA view, a sharp sniff, and how far each dome moves");
    this.run.onclick = () => void this.begin();
    this.back.onclick = () => void this.end();
    this.element.append(make("div", { className: "sniff-acts" }, this.run, this.back), this.words, this.plot);
  }

  /** The result of the test; undefined before it is known. */
  get result(): SniffResult | undefined {
    return this.test?.result;
  }

  private async begin(): Promise<void> {
    const refusal = this.actions.refusal();
    this.words.textContent = refusal;
    if (refusal !== "") return;
    this.shown();
    this.words.textContent = t("Waiting for the next sniff…");
    this.back.hidden = this.plot.hidden = false;
    this.test = undefined;
    await this.actions.start();
    this.test = new SniffTest();
  }

  private async end(): Promise<void> {
    this.back.hidden = this.plot.hidden = true;
    this.words.textContent = "";
    this.test = undefined;
    await this.actions.stop();
  }

  /** Receives every frame. */
  receive(frame: Frame): void {
    const heights = domeHeights(frame);
    if (this.test === undefined || heights === undefined) return;
    if (this.test.receive(heights)) this.words.textContent = sniffWords(this.test.result!);
  }

  /** Draws the plot. */
  draw(): void {
    if (this.test === undefined) return;
    const key = (["right", "left"] as const).map((side) => {
      const line = svg("svg", { viewBox: "0 0 18 8", class: "sniff-key", "aria-hidden": "true" });
      line.append(svg("line", { x1: 0, x2: 18, y1: 4, y2: 4, stroke: domeColors[side], "stroke-width": 3 }));
      return make("span", {}, line, t(`${side} dome`));
    });
    this.plot.replaceChildren(
      sniffPlot(this.test.heights, this.result),
      make("div", { className: "sniff-keys" }, ...key),
    );
  }
}

/** Returns the heights of both domes in a frame; undefined without the measures. */
export function domeHeights({ time, breath, measures }: Frame): DomeHeights | undefined {
  const value = (name: string) => measures.find((each) => each.name === name)?.value;
  const [right, left] = [value("right dome"), value("left dome")];
  return right === undefined || left === undefined ? undefined : { time, breath, right, left };
}
