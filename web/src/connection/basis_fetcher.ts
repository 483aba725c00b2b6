import type { GetBasisResponse } from "../gen/phrenic/v1/frames_pb";

/** Fetches the shapes that frames are put together from, beside the frames, when there are newer ones. */
export class BasisFetcher {
  private knownEpoch = 0n;
  private fetching = false;

  constructor(
    private readonly request: () => Promise<GetBasisResponse>,
    private readonly onBasis: (basis: GetBasisResponse) => void,
  ) {}

  /** Of the basis that this viewer has; 0 where it has none. */
  get epoch(): bigint {
    return this.knownEpoch;
  }

  /** The server has a basis of that epoch. */
  offered(epoch: bigint): void {
    if (epoch > this.knownEpoch && !this.fetching) void this.fetch();
  }

  private async fetch(): Promise<void> {
    this.fetching = true;
    try {
      const basis = await this.request();
      this.onBasis(basis);
      this.knownEpoch = basis.epoch;
    } catch {
      // The next acknowledgement offers it again.
    }
    this.fetching = false;
  }
}
