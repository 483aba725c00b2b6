import { Signal } from "./signal";

/** Some parameters by name. */
export type Values = Record<string, number | boolean>;

interface Change {
  before: Values;
  after: Values;
  at: number;
}

/** Changes of one parameter that follow each other so closely are one change: a drag over a slider [ms]. */
const mergeInterval = 1000;
const maxChanges = 100;

/** What this viewer changed, so that it can be taken back and done again; others' changes are theirs. */
export class UndoHistory {
  /** Whether there is something to take back, and something to do again. */
  readonly state = new Signal({ undo: false, redo: false });
  private readonly done: Change[] = [];
  private undone: Change[] = [];

  /** Takes note of a change at `now` [ms] from `before` to `after`, of which the same names count. */
  record(before: Values, after: Values, now: number): void {
    const last = this.done.at(-1);
    const same = last !== undefined && sameNames(last.after, after) && now - last.at < mergeInterval;
    if (same) Object.assign(last, { after, at: now });
    else this.done.push({ before, after, at: now });
    if (this.done.length > maxChanges) this.done.shift();
    this.undone = [];
    this.notify();
  }

  /** What to set to take the last change back. */
  undo(): Values | undefined {
    const change = this.done.pop();
    if (change !== undefined) this.undone.push({ ...change, at: -Infinity });
    this.notify();
    return change?.before;
  }

  /** What to set to do again what was taken back last. */
  redo(): Values | undefined {
    const change = this.undone.pop();
    if (change !== undefined) this.done.push(change);
    this.notify();
    return change?.after;
  }

  private notify(): void {
    this.state.set({ undo: this.done.length > 0, redo: this.undone.length > 0 });
  }
}

function sameNames(a: Values, b: Values): boolean {
  return Object.keys(a).sort().join() === Object.keys(b).sort().join();
}
