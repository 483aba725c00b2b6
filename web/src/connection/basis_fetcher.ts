import type { GetBasisResponse } from "../gen/phrenic/v1/frames_pb";

/** Fetches the shapes that frames are put together from, beside the frames, when there are newer ones. */
export class Learner {
  private known = 0n;
  private asking = false;

  constructor(
    private readonly ask: () => Promise<GetBasisResponse>,
    private readonly learned: (basis: GetBasisResponse) => void,
  ) {}

  /** Of the basis that this viewer has; 0 where it has none. */
  get epoch(): bigint {
    return this.known;
  }

  /** The server has a basis of that epoch. */
  offered(epoch: bigint): void {
    if (epoch > this.known && !this.asking) void this.fetch();
  }

  private async fetch(): Promise<void> {
    this.asking = true;
    try {
      const basis = await this.ask();
      this.learned(basis);
      this.known = basis.epoch;
    } catch {
      // The next acknowledgement offers it again.
    }
    this.asking = false;
  }
}
