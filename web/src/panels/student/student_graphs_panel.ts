import { make } from "../../dom/elements";
import type { Frame } from "../../gen/phrenic/v1/frames_pb";
import type { GraphSpec } from "../../graphs/catalogue";
import {
  besideGraph,
  joinSeries,
  type PredictionSubject,
  predictionSubjects,
  studentGraphs,
} from "../../graphs/student_graphs";
import type { ShownReferences } from "../../graphs/references";
import { TimeSeries } from "../../state/time_series";
import { GraphTile } from "../readings/graph_tile";
import { refusalWords } from "../readings/refusal_words";
import { t } from "../../language/translate";

/** Time shown [simulated s]. */
const span = 12;

/** The data of a second session, and what it is called now. */
export interface SeriesBeside {
  history: TimeSeries;
  label(): string;
}

/** Two graphs: lung volume, and the domes or the pressure. A second session has dashed curves in the same graphs. */
export class StudentGraphsPanel {
  readonly element = make("section", { id: "student-graphs", ariaLabel: t("Graphs") });
  private readonly tiles = make("div");
  private readonly kinds = make("div", { className: "causes kinds", role: "group", ariaLabel: t("Second graph") });
  private readonly refusal = make("p", { className: "faint", role: "status" });
  private readonly joined = new TimeSeries(2 * span);
  private specs: ReturnType<typeof studentGraphs> = { volume: undefined, others: [] };
  /** What can be predicted in the scene. */
  subjects: PredictionSubject[] = [];
  private shown: GraphTile[] = [];
  private chosen = 0;
  /** The name of the second session in the graphs. */
  private label = "";
  private key = "";

  /** `beside` is undefined without a second session. */
  constructor(
    private readonly history: TimeSeries,
    private readonly beside: SeriesBeside | undefined,
    private readonly fileName: () => string,
    private readonly references: () => ShownReferences | undefined = () => undefined,
  ) {
    this.element.append(make("h2", { className: "unseen" }, t("Graphs")), this.refusal, this.tiles, this.kinds);
  }

  /** Reads the available graphs from a frame. */
  receive(frame: Frame): void {
    const specs = studentGraphs(frame);
    const key = JSON.stringify(specs);
    if (key === this.key) return;
    [this.key, this.specs, this.chosen] = [key, specs, 0];
    this.subjects = predictionSubjects(frame);
    this.build();
  }

  /** Draws the newest data. */
  draw(): void {
    if (this.element.clientWidth === 0) return;
    if (this.beside !== undefined) {
      joinSeries(this.joined, this.history, this.beside.history, span);
      if (this.beside.label() !== this.label) this.build();
    }
    const end = Math.max(this.drawn.times.at(-1) ?? 0, span);
    for (const tile of this.shown) tile.show({ start: end - span, end }, undefined);
  }

  /** Says why samples of the sessions cannot be read, or nothing if they can. */
  refused(reasons: string[]): void {
    const words = refusalWords(reasons.find((each) => each !== "") ?? "");
    if (words !== this.refusal.textContent) this.refusal.textContent = words;
  }

  private get drawn(): TimeSeries {
    return this.beside === undefined ? this.history : this.joined;
  }

  private build(): void {
    const { volume, others } = this.specs;
    this.label = this.beside?.label() ?? "";
    const specs = [volume, others[this.chosen]].filter((each) => each !== undefined);
    const events = { zoom: () => undefined, resume: () => undefined, cursor: () => undefined };
    this.shown = specs.map(
      (spec) => new GraphTile(this.withBeside(spec), this.drawn, this.fileName, events, this.references),
    );
    this.tiles.replaceChildren(...this.shown.map(({ element }) => element));
    this.kinds.hidden = others.length < 2;
    this.kinds.replaceChildren(...others.map(({ title }, i) => this.kindButton(title, i)));
  }

  private withBeside(spec: GraphSpec): GraphSpec {
    return this.beside === undefined ? spec : besideGraph(spec, t("chosen"), this.label);
  }

  private kindButton(title: string, i: number): HTMLElement {
    const onclick = () => {
      this.chosen = i;
      this.build();
      this.draw();
      this.kinds.querySelectorAll("button")[i]?.focus();
    };
    return make("button", { type: "button", ariaPressed: String(i === this.chosen), onclick }, t(title));
  }
}
