import { make } from "../dom/elements";
import type { Frame } from "../gen/phrenic/v1/frames_pb";
import { graphsOf, valuesOf } from "../graphs/catalogue";
import { GraphTile } from "../panels/readings/graph_tile";
import { TimeSeries } from "../state/time_series";
import { t } from "../language/translate";

/** The graphs of a whole motion, with a line at the displayed time. */
export class BreathGraphs {
  readonly element = make("div", { className: "graphs" });
  private readonly history: TimeSeries;
  private readonly tiles: GraphTile[];
  private readonly length: number;

  /** `times` are those of the frames [s], from 0. */
  constructor(frames: Frame[], times: number[], fileName: string) {
    this.length = times[times.length - 1];
    this.history = new TimeSeries(this.length + 1);
    frames.forEach((frame, i) => this.history.add(times[i], valuesOf(frame)));
    const events = { zoom: () => undefined, resume: () => undefined, cursor: () => undefined };
    this.tiles = graphsOf(frames[0]).map((spec) => new GraphTile(spec, this.history, () => fileName, events));
    this.element.append(make("h2", { className: "unseen" }, t("Graphs")), ...this.tiles.map(({ element }) => element));
  }

  /** Draws the curves; to be called when the graphs are in the page. */
  draw(): void {
    for (const tile of this.tiles) tile.show({ start: 0, end: this.length || 1 }, undefined);
  }

  /** Marks a time [s] and shows the values of the frame at `index`. */
  mark(time: number, index: number): void {
    for (const tile of this.tiles) tile.mark(time, index);
  }
}
