import type { Clock } from "../../../web/src/timing/clock";

/** A clock that only advances when a test calls `advance`. */
export class FakeClock implements Clock {
  private time = 0;
  private sleepers: { until: number; wake: () => void }[] = [];
  /** Durations of all calls of `sleep` [ms]. */
  readonly sleeps: number[] = [];

  now(): number {
    return this.time;
  }

  sleep(milliseconds: number, signal?: AbortSignal): Promise<void> {
    this.sleeps.push(milliseconds);
    return new Promise((resolve) => {
      if (signal?.aborted) return resolve();
      this.sleepers.push({ until: this.time + milliseconds, wake: resolve });
      signal?.addEventListener("abort", () => resolve());
    });
  }

  /** Advances the time and runs everything that is due. */
  async advance(milliseconds: number): Promise<void> {
    await settle();
    this.time += milliseconds;
    const due = this.sleepers.filter(({ until }) => until <= this.time);
    this.sleepers = this.sleepers.filter(({ until }) => until > this.time);
    for (const { wake } of due) wake();
    await settle();
  }
}

/** Lets pending promises and streams run until they wait for time or input. */
export async function settle(): Promise<void> {
  for (let i = 0; i < 20; i++) await new Promise((resolve) => setImmediate(resolve));
}
