import { button, make } from "../../dom/elements";
import { icon } from "../../dom/icons";
import type { Frame } from "../../gen/phrenic/v1/frames_pb";
import { campbellGraph, graphsOf, type GraphSpec, valuesOf } from "../../graphs/catalogue";
import type { ShownReferences } from "../../graphs/references";
import type { TimeSpan } from "../../graphs/window";
import { TimeSeries } from "../../state/time_series";
import { GraphTile } from "./graph_tile";
import { MModePictures } from "./m_mode_pictures";
import { refusalWords } from "./refusal_words";
import { fixed, t } from "../../language/translate";

/** Duration that is kept, and the durations that can be shown [simulated s]. */
const kept = 120;
const lengths = [6, 12, 30, 60, 120];

/** A graph of what this viewer tracks or measures, with its values. */
export interface TrackedSeries {
  spec: GraphSpec;
  history: TimeSeries;
}

/** Graphs of all measures and probes on a common time axis; they hold, zoom and resume together. */
export class GraphsPanel {
  readonly element = make("div", { className: "graphs" });
  /** The pictures beside the graph of the domes. */
  readonly mMode = new MModePictures(kept);
  private readonly history = new TimeSeries(kept);
  private readonly list = make("div", { className: "tiles" });
  private readonly pause: HTMLButtonElement;
  private readonly words = make("span", { className: "faint", id: "graphs-span" });
  private readonly length = make("select", { id: "graphs-length", ariaLabel: t("Time shown"), title: t("Time shown") });
  private tiles: GraphTile[] = [];
  private specsKey = "";
  private held: TimeSpan | undefined;
  private drawn = -1;
  private refusal = "";

  constructor(
    private readonly fileName: () => string,
    private readonly tracked: () => TrackedSeries[],
    private readonly references: () => ShownReferences | undefined,
  ) {
    this.length.append(...lengths.map((each) => make("option", { value: String(each) }, `${each} s`)));
    this.length.value = "12";
    this.length.onchange = () => this.resume();
    this.pause = button(
      t("Hold the graphs"),
      () => (this.held ? this.resume() : this.hold(this.newest())),
      icon("pause"),
    );
    this.pause.id = "graphs-pause";
    this.pause.className = "quiet";
    const title = make("h2", {}, t("Graphs"));
    this.element.append(make("header", { className: "bar" }, title, this.words, this.length, this.pause), this.list);
  }

  /** Records the numbers of a sample. */
  record(numbers: Frame, present: boolean): void {
    this.history.add(numbers.time, valuesOf(numbers), present);
  }

  /** Reads from a frame which graphs there are. */
  receive(frame: Frame): void {
    const curves = this.references()?.curves ?? [];
    const campbell = curves.length > 0 ? campbellGraph(frame) : [];
    const [specs, tracked] = [withCampbell(graphsOf(frame), campbell), this.tracked()];
    const offered = JSON.stringify([...specs, ...tracked.map(({ spec }) => spec)]);
    if (offered === this.specsKey) return;
    this.specsKey = offered;
    this.rebuild([...specs.map((spec) => ({ spec, history: this.history })), ...tracked]);
  }

  /** Draws again what is behind the curves, which has changed; `frame` is the newest one. */
  refresh(frame: Frame | undefined): void {
    if (frame !== undefined) this.receive(frame);
    this.drawn = -1;
  }

  /** Removes all data, for another scene. */
  clear(): void {
    this.history.clear();
    this.resume();
  }

  /** Begins new curves: samples are missing. */
  gap(): void {
    this.history.clear();
  }

  /** Says why samples cannot be read, or nothing if they can. */
  refused(reason: string): void {
    this.refusal = refusalWords(reason);
    if (this.held === undefined) this.words.textContent = this.refusal;
  }

  /** Draws new data; returns early if there is none. */
  draw(): void {
    const { times } = this.history;
    const last = times.at(-1) ?? 0;
    if (last === this.drawn || this.held !== undefined || this.element.clientWidth === 0) return;
    this.drawn = last;
    this.show(this.newest());
  }

  private rebuild(series: TrackedSeries[]): void {
    const events = {
      zoom: (span: TimeSpan) => this.hold(span),
      resume: () => this.resume(),
      cursor: (place: number | undefined) => this.tiles.forEach((tile) => tile.showValues(place)),
    };
    this.tiles = series.map(
      ({ spec, history }) => new GraphTile(spec, history, this.fileName, events, this.references),
    );
    this.list.replaceChildren(...this.tiles.map(({ element }) => element));
    this.list.querySelector('[data-graph="domes"]')?.after(this.mMode.element);
    this.drawn = -1;
  }

  private newest(): TimeSpan {
    const end = Math.max(this.history.times.at(-1) ?? 0, Number(this.length.value));
    return { start: end - Number(this.length.value), end };
  }

  private hold(span: TimeSpan): void {
    this.held = span;
    this.words.textContent = t("held, {0} to {1} s", fixed(span.start, 1), fixed(span.end, 1));
    this.label(t("Resume the graphs"), "play");
    this.show(span);
  }

  private resume(): void {
    this.held = undefined;
    this.drawn = -1;
    this.words.textContent = this.refusal;
    this.label(t("Hold the graphs"), "pause");
    this.draw();
  }

  private label(words: string, name: "play" | "pause"): void {
    this.pause.ariaLabel = this.pause.title = words;
    this.pause.replaceChildren(icon(name));
  }

  private show(span: TimeSpan): void {
    for (const tile of this.tiles) tile.show(span, undefined);
    this.mMode.show(span);
  }
}

/** Puts the Campbell diagram beside the other loops. */
function withCampbell(specs: GraphSpec[], campbell: GraphSpec[]): GraphSpec[] {
  const after = specs.findLastIndex(({ abscissa }) => abscissa !== undefined) + 1;
  return specs.toSpliced(after, 0, ...campbell);
}
