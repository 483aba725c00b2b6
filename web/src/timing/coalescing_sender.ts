import type { Clock } from "./clock";

/**
 * Sends changes of named values at most once an interval and one at a time; what waits is overwritten by what is newer.
 * A drag over a slider thus becomes a few calls, and the last value always arrives.
 */
export class NewestWins<T extends object> {
  private waiting: Partial<T> = {};
  private underway: Partial<T> = {};
  private running = false;

  /** `send` handles its own errors; `settled` hears when what was sent is no longer pending. */
  constructor(
    private readonly send: (change: Partial<T>) => Promise<void>,
    private readonly clock: Clock,
    private readonly settled: () => void,
    private readonly interval = 100,
  ) {}

  push(change: Partial<T>): void {
    Object.assign(this.waiting, change);
    if (!this.running) void this.run();
  }

  /** Sends at once what waits, also beside what is underway: there is no later. */
  flush(): void {
    const last = this.waiting;
    this.waiting = {};
    if (Object.keys(last).length > 0) void this.send(last);
  }

  /** Whether a change of `name` has not been answered yet. */
  pending(name: keyof T): boolean {
    return name in this.waiting || name in this.underway;
  }

  private async run(): Promise<void> {
    this.running = true;
    while (Object.keys(this.waiting).length > 0) {
      this.underway = this.waiting;
      this.waiting = {};
      await Promise.all([this.send(this.underway), this.clock.sleep(this.interval)]);
      this.underway = {};
      this.settled();
    }
    this.running = false;
  }
}
