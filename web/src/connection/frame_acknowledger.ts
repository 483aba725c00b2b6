import type { AckFramesResponse } from "../gen/phrenic/v1/frames_pb";
import type { Clock } from "../timing/clock";

/** How long to wait after an acknowledgement that failed [ms]: without one no more frames come. */
const pause = 500;

/**
 * Tells the server which frames have come, the newest alone and one call at a time: what a slow machine or line leaves
 * waiting is not sent on top, so that what is shown is never old. One call for half of the frames that may be on their
 * way is enough to keep them coming.
 */
export class Acknowledger {
  private newest = 0n;
  private taken = 0; // since the last call
  private enough = 1; // for a call
  private running = false;

  constructor(
    private readonly send: (sequence: bigint) => Promise<AckFramesResponse>,
    private readonly clock: Clock,
    private readonly signal: AbortSignal,
    private readonly answered: (response: AckFramesResponse, sent: number, at: number) => void,
  ) {}

  received(sequence: bigint): void {
    this.newest = sequence;
    this.taken++;
    if (!this.running) void this.run();
  }

  private async run(): Promise<void> {
    this.running = true;
    while (this.taken >= this.enough && !this.signal.aborted) await this.tell(this.newest);
    this.running = false;
  }

  private async tell(sequence: bigint): Promise<void> {
    const sent = this.clock.now();
    const taken = this.taken;
    try {
      const response = await this.send(sequence);
      this.taken -= taken;
      this.enough = Math.max(1, Math.floor(response.maxUnackedFrames / 2));
      this.answered(response, sent, this.clock.now());
    } catch {
      await this.clock.sleep(pause, this.signal); // a line that is lost is noticed by who watches
    }
  }
}
