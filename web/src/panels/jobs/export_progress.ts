import { make } from "../../dom/elements";
import { alertMessage } from "../../dom/rows";
import type { ExportProgress } from "../../session/exports";
import type { Signal } from "../../state/signal";
import { fixed, t } from "../../language/translate";

/** Something that makes a file, and can be stopped. */
export interface FileMaking {
  progress: Signal<ExportProgress>;
  stop(): void;
}

const verbs = { recording: "Recording", fetching: "Fetching", filming: "Drawing the film" };

/**
 * Shows the progress and a link to the finished file; `start` is disabled while a file is made. The ids of the elements
 * begin with `id`. The focus follows: from `start` to the button that stops, and from there to what comes after.
 */
export function exportProgress(making: FileMaking, start: HTMLButtonElement, id: string): HTMLElement {
  const place = make("div", { id: `${id}-progress` });
  const running = new RunningRow(() => making.stop());
  making.progress.subscribe((work) => {
    const focused = document.activeElement === start || place.contains(document.activeElement);
    const runs = work.kind === "recording" || work.kind === "fetching" || work.kind === "filming";
    start.disabled = runs;
    if (runs) {
      running.show(work);
      if (!place.contains(running.stop)) place.replaceChildren(...running.elements);
    } else place.replaceChildren(...finishedElements(work, id));
    if (focused) (runs ? running.stop : (place.querySelector("a") ?? start)).focus();
  });
  return place;
}

type Running = Extract<ExportProgress, { done: number }>;

/** A bar with words and a button that stops, which stay the same elements while a file is made. */
class RunningRow {
  readonly stop: HTMLButtonElement;
  readonly elements: HTMLElement[];
  private readonly verb = make("span");
  private readonly left = make("span");
  private readonly bar = make("progress", { max: 1, ariaLabel: t("Progress of the export") });

  constructor(stop: () => void) {
    this.stop = make("button", { type: "button", onclick: stop }, t("Stop"));
    this.verb.setAttribute("role", "status");
    const words = make("p", { className: "faint" }, this.verb, this.left);
    this.elements = [words, make("div", { className: "row" }, this.bar, this.stop)];
  }

  show(work: Running): void {
    const seconds = work.kind === "recording" ? work.secondsLeft : undefined;
    const verb = t(verbs[work.kind]);
    if (this.verb.textContent !== verb) this.verb.textContent = verb;
    this.left.textContent = seconds === undefined ? "…" : t(", {0} s left…", seconds.toFixed(0));
    this.bar.value = work.done;
  }
}

function finishedElements(work: ExportProgress, id: string): HTMLElement[] {
  if (work.kind === "failed") return [alertMessage(work.message)];
  if (work.kind !== "ready") return [];
  const size = fixed(work.size / 1e6, 1);
  return [
    make("a", { href: work.url, download: work.file, id: `${id}-link` }, t("Save {0} ({1} MB)", work.file, size)),
  ];
}
