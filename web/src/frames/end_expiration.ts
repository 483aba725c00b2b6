/** Notices the end of each expiration: where the breath signal stops falling. */
export class EndExpirationDetector {
  private falling = false;
  private last: number | undefined;

  /** True where the signal has just turned upwards. */
  receive(breath: number): boolean {
    const last = this.last;
    this.last = breath;
    if (last === undefined || breath === last) return false;
    const turned = this.falling && breath > last;
    this.falling = breath < last;
    return turned;
  }
}
