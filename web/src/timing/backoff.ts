/** Exponential backoff with jitter: delays double from `first` to `maximum`, each reduced by up to half at random. */
export class Backoff {
  private attempt = 0;

  constructor(
    private readonly first = 500,
    private readonly maximum = 10_000,
    private readonly random: () => number = Math.random,
  ) {}

  /** Returns the next delay [ms]. Jitter prevents that all viewers of a class reconnect at the same moment. */
  next(): number {
    const whole = Math.min(this.maximum, this.first * 2 ** this.attempt);
    this.attempt = Math.min(this.attempt + 1, 30);
    return whole * (1 - this.random() / 2);
  }

  /** Starts again with the first delay. */
  reset(): void {
    this.attempt = 0;
  }
}
