import type { Clock } from "./clock";

/**
 * Sends changes of named values at most once an interval and one at a time; what waits is overwritten by what is newer.
 * A drag over a slider thus becomes a few calls, and the last value always arrives.
 */
export class CoalescingSender<T extends object> {
  private queued: Partial<T> = {};
  private inFlight: Partial<T> = {};
  private running = false;

  /** `send` handles its own errors; `settled` hears when what was sent is no longer pending. */
  constructor(
    private readonly send: (change: Partial<T>) => Promise<void>,
    private readonly clock: Clock,
    private readonly onSettled: () => void,
    private readonly interval = 100,
  ) {}

  push(change: Partial<T>): void {
    Object.assign(this.queued, change);
    if (!this.running) void this.run();
  }

  /** Sends at once what waits, also beside what is underway: there is no later. */
  flush(): void {
    const last = this.queued;
    this.queued = {};
    if (Object.keys(last).length > 0) void this.send(last);
  }

  /** Whether a change of `name` has not been answered yet. */
  pending(name: keyof T): boolean {
    return name in this.queued || name in this.inFlight;
  }

  private async run(): Promise<void> {
    this.running = true;
    while (Object.keys(this.queued).length > 0) {
      this.inFlight = this.queued;
      this.queued = {};
      await Promise.all([this.send(this.inFlight), this.clock.sleep(this.interval)]);
      this.inFlight = {};
      this.onSettled();
    }
    this.running = false;
  }
}
