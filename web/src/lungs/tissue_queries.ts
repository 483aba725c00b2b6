import { type Api, errorText } from "../connection/api";
import type { PointReading, ReadTissueResponse } from "../gen/phrenic/v1/tissue_pb";
import { floats } from "../geometry/wire_arrays";
import { Signal } from "../state/signal";
import { Lattice } from "./lattice";
import { TissueState } from "./tissue_state";

/** Number of stored samples: 20 s at ten queries per second. */
const maxSamples = 200;
/** Largest time from a sample to a frame that it is shown with [s]. */
const maxTimeDistance = 0.3;

/** The amplitudes of each lung at one time [s]. */
interface Sample {
  time: number;
  amplitudes: Float32Array[];
}

/** What was read of the tissue, live. */
export interface TissueReadings {
  time: number;
  regions: [name: string, ventilation: number][];
  points: PointReading[];
}

/** Reads the lungs' tissue of a session, one query at a time, and stores the amplitudes for replay. */
export class TissueQueries {
  /** The lungs; empty before the first query. */
  readonly lungs = new Signal<Lattice[]>([]);
  readonly readings = new Signal<TissueReadings | undefined>(undefined);
  /** Why there is no tissue; otherwise empty. */
  readonly message = new Signal("");
  private querying = false;
  private refused = false;
  private answered = "";
  private samples: Sample[] = [];
  private scene = 0;

  constructor(
    private readonly api: Api,
    private readonly sessionId: string,
  ) {}

  /** Forgets the lungs, for another scene. */
  start(): void {
    this.scene++;
    this.refused = false;
    this.answered = "";
    this.samples = [];
    this.lungs.set([]);
    this.readings.set(undefined);
    this.message.set("");
  }

  /**
   * Reads the tissue unless that of this state is known, a query is running, or the scene has none. `points` are places
   * at rest, x y z [m]; `stateKey` identifies the state.
   */
  async query(points: readonly (readonly [number, number, number])[], stateKey: string): Promise<void> {
    const question = `${stateKey} ${JSON.stringify(points)}`;
    if (this.querying || this.refused || question === this.answered) return;
    this.querying = true;
    const { scene } = this;
    try {
      if (this.lungs.value.length === 0) await this.load(scene);
      const asked = points.map(([x, y, z]) => ({ x, y, z }));
      const answer = await this.api.tissue.readTissue({ sessionId: this.sessionId, points: asked });
      if (scene !== this.scene) return;
      this.answered = question;
      this.store(answer);
    } catch (error) {
      if (scene !== this.scene) return;
      this.refused = this.lungs.value.length === 0;
      this.message.set(`The lungs' tissue cannot be read: ${errorText(error)}.`);
    } finally {
      this.querying = false;
    }
  }

  /** Returns the tissue of each lung at a time [s], interpolated; empty if no sample is near. */
  at(time: number): TissueState[] {
    const next = this.samples.findIndex((each) => each.time >= time);
    const [before, after] = next < 0 ? this.samples.slice(-2) : this.samples.slice(Math.max(0, next - 1), next + 1);
    const last = after ?? before;
    if (last === undefined) return [];
    const away = Math.min(...[before, last].map((each) => Math.abs(each.time - time)));
    if (away > maxTimeDistance) return [];
    // The newest sample is a little older than the frame: the motion goes on as between the last two.
    const span = last.time - before.time;
    const part = span > 0 && span <= 2 * maxTimeDistance ? (time - before.time) / span : 1;
    return this.lungs.value.map((lattice, i) => {
      const [from, to] = [before.amplitudes[i], last.amplitudes[i]];
      return new TissueState(
        lattice,
        to.map((value, k) => from[k] + Math.min(2, Math.max(0, part)) * (value - from[k])),
      );
    });
  }

  private async load(scene: number): Promise<void> {
    this.message.set("Computing how the lungs' tissue moves …");
    const lungs: Lattice[] = [];
    for await (const lung of this.api.tissue.getTissue({ sessionId: this.sessionId })) lungs.push(new Lattice(lung));
    if (scene === this.scene) this.lungs.set(lungs);
  }

  /** Time that goes back means that the session was reset. */
  private store({ time, lungs, points }: ReadTissueResponse): void {
    if (time < (this.samples.at(-1)?.time ?? 0)) this.samples = [];
    const amplitudes = lungs.map((each) => floats(each.amplitudes, 1, "amplitudes"));
    if (time > (this.samples.at(-1)?.time ?? -1))
      this.samples = [...this.samples.slice(1 - maxSamples), { time, amplitudes }];
    const regions = lungs.flatMap((lung) =>
      lung.regions.map(({ name, ventilation }): [string, number] => [`${lung.name} ${name}`, ventilation]),
    );
    this.message.set("");
    this.readings.set({ time, regions, points });
  }
}
