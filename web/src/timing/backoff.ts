/** Waiting times between attempts: they double from `first` to `longest`, each shortened by up to half at random. */
export class Backoff {
  private attempt = 0;

  constructor(
    private readonly first = 500,
    private readonly maximum = 10_000,
    private readonly random: () => number = Math.random,
  ) {}

  /** The next wait [ms]. The jitter keeps a class of viewers from returning to a restarted server in one instant. */
  next(): number {
    const whole = Math.min(this.maximum, this.first * 2 ** this.attempt);
    this.attempt = Math.min(this.attempt + 1, 30);
    return whole * (1 - this.random() / 2);
  }

  reset(): void {
    this.attempt = 0;
  }
}
