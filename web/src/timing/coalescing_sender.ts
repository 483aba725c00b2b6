import type { Clock } from "./clock";

/**
 * Sends changes of named values at most once per interval and one call at a time; newer values replace queued ones. A
 * drag of a slider thus causes few calls, and the last value is always sent.
 */
export class CoalescingSender<T extends object> {
  private queued: Partial<T> = {};
  private inFlight: Partial<T> = {};
  private running = false;

  /** `send` handles its own errors; `onSettled` is called when a call has ended. */
  constructor(
    private readonly send: (change: Partial<T>) => Promise<void>,
    private readonly clock: Clock,
    private readonly onSettled: () => void,
    private readonly interval = 100,
  ) {}

  /** Queues a change and sends it as soon as possible. */
  push(change: Partial<T>): void {
    Object.assign(this.queued, change);
    if (!this.running) void this.run();
  }

  /** Sends queued changes immediately, also during another call, before the page is closed. */
  flush(): void {
    const last = this.queued;
    this.queued = {};
    if (Object.keys(last).length > 0) void this.send(last);
  }

  /** True if a change of `name` is queued or not answered yet. */
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
