import { Signal } from "./signal";

/** Parameter values by name. */
export type Values = Record<string, number | boolean>;

interface Change {
  before: Values;
  after: Values;
  at: number;
}

/** Changes of the same parameters within this interval are merged, such as a drag of a slider [ms]. */
const mergeInterval = 1000;
const maxChanges = 100;

/** The undo history of this viewer's changes; those of others are not included. */
export class UndoHistory {
  /** Whether undo and redo are possible. */
  readonly state = new Signal({ undo: false, redo: false });
  private readonly done: Change[] = [];
  private undone: Change[] = [];

  /** Records a change at `now` [ms]; `before` and `after` have the same names. */
  record(before: Values, after: Values, now: number): void {
    const last = this.done.at(-1);
    const same = last !== undefined && sameNames(last.after, after) && now - last.at < mergeInterval;
    if (same) Object.assign(last, { after, at: now });
    else this.done.push({ before, after, at: now });
    if (this.done.length > maxChanges) this.done.shift();
    this.undone = [];
    this.notify();
  }

  /** Returns the values that undo the last change. */
  undo(): Values | undefined {
    const change = this.done.pop();
    if (change !== undefined) this.undone.push({ ...change, at: -Infinity });
    this.notify();
    return change?.before;
  }

  /** Returns the values that redo the last undone change. */
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
