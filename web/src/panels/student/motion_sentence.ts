import { make } from "../../dom/elements";
import type { Frame } from "../../gen/phrenic/v1/frames_pb";
import type { Parameters } from "../../gen/phrenic/v1/parameters_pb";
import { breathMotion, type BreathMotion, type MotionKeys } from "../../graphs/breath_motion";
import { motionWords } from "../../graphs/motion_words";
import { motionKeys } from "../../graphs/student_graphs";
import { breathLengthOf } from "../../parameters/effort";
import type { TimeSeries } from "../../state/time_series";
import { t } from "../../language/translate";

/** A session whose breath is told in words. */
export interface BreathSource {
  history: TimeSeries;
  /** The parameters of the session now; undefined before they are known. */
  parameters(): Parameters | undefined;
}

/** A second session, and what it is called. */
export interface NamedSource extends BreathSource {
  label: string;
}

/** Shortest time between two sentences, so that a screen reader is not interrupted [simulated s]. */
const interval = 4;

/** The last breath in a sentence with its numbers, beside that of the second if a second session is shown. */
export class MotionSentence {
  readonly element = make("p", { id: "motion-words" });
  private keys: MotionKeys | undefined;
  private changes = [new ChangeDetector(), new ChangeDetector()];
  private toldAt = -Infinity;
  private told = "";

  constructor() {
    this.element.setAttribute("role", "status");
  }

  /** Reads the places of the values from a frame. */
  receive(frame: Frame): void {
    this.keys ??= motionKeys(frame);
  }

  /** Shows the last breath as a sentence; waits for a whole breath after each change. */
  show(here: BreathSource, beside: NamedSource | undefined): void {
    const now = here.history.times.at(-1) ?? 0;
    const [own, other] = [here, beside].map((each, i) => each && this.motionOf(each, this.changes[i]));
    const waiting = own === undefined || (beside !== undefined && other === undefined);
    const words = waiting
      ? t("Wait for a whole breath …")
      : motionWords(own, beside && other && { label: beside.label, motion: other });
    const changed = this.changes.some((each) => each.takeChange());
    if (!changed && !waiting && this.told !== "" && Math.abs(now - this.toldAt) < interval) return;
    if (waiting && this.told !== "" && !changed) return;
    [this.toldAt, this.told] = [now, waiting ? "" : words];
    if (this.element.textContent !== words) this.element.textContent = words;
  }

  private motionOf({ history, parameters }: BreathSource, change: ChangeDetector): BreathMotion | undefined {
    const values = parameters();
    if (values === undefined || this.keys === undefined) return undefined;
    const since = change.timeOfChange(JSON.stringify(values), history.times.at(-1) ?? 0);
    return breathMotion(history, this.keys, breathLengthOf(values), since);
  }
}

/** Finds when the parameters of a session changed last. */
class ChangeDetector {
  private seen: string | undefined;
  private since = 0;
  private changed = false;

  /** Returns the simulated time [s] of the last change; 0 if the parameters have not changed. */
  timeOfChange(values: string, now: number): number {
    if (this.seen !== undefined && this.seen !== values) {
      this.since = now;
      this.changed = true;
    }
    if (now < this.since) this.since = 0;
    this.seen = values;
    return this.since;
  }

  /** True once after a change. */
  takeChange(): boolean {
    const changed = this.changed;
    this.changed = false;
    return changed;
  }
}
