import { type Api, errorText } from "../connection/api";
import type { ComparedMesh, CompareResponse, ComparisonTable, SurfaceDistance } from "../gen/phrenic/v1/compare_pb";
import type { Surface } from "../geometry/surface";
import { floats, indices } from "../geometry/wire_arrays";
import { Signal } from "../state/signal";

/** Settings of a comparison with a file. */
export interface ComparisonChoices {
  /** The body to compare. */
  body: string;
  /** Millimetres per unit of the file. */
  unitMm: number;
  /** Time of the state in a motion file [s]; undefined for the time of the session. */
  time: number | undefined;
}

/** A file from the browser. */
export type SurfaceFile = Pick<File, "name" | "size" | "arrayBuffer">;

/** The distances between a body and the surface of a file. */
export interface Comparison {
  file: string;
  body: string;
  /** Simulated time [s] and tick of the compared state. */
  time: number;
  tick: bigint;
  distance: SurfaceDistance;
  /** What makes the distances doubtful, such as a wrong unit of the file. */
  warnings: string[];
  /** Distance of each vertex of the body [mm]; NaN for a vertex without a triangle. */
  distances: number[];
  /** The surface of the file. */
  surface: Surface | undefined;
}

/** State of the comparison; `done` is a fraction from 0 to 1. */
export type ComparisonProgress =
  { kind: "idle" } | { kind: "running"; file: string; done: number } | { kind: "failed"; message: string };

/** The server accepts messages of at most 16 MiB, including the other fields of the request. */
const maxBytes = (16 << 20) - 4096;

/** Compares a body of one session in its current state with a file; one comparison at a time. */
export class Comparisons {
  readonly result = new Signal<Comparison | undefined>(undefined);
  readonly progress = new Signal<ComparisonProgress>({ kind: "idle" });
  /** True if the surface of the file is drawn. */
  readonly surfaceVisible = new Signal(true);
  readonly choices = new Signal<ComparisonChoices>({ body: "", unitMm: 1, time: undefined });
  private file: { name: string; content: Uint8Array } | undefined;
  private running = new AbortController();

  constructor(
    private readonly api: Api,
    private readonly sessionId: string,
  ) {}

  /** Changes some settings of the next comparison. */
  choose(choices: Partial<ComparisonChoices>): void {
    this.choices.set({ ...this.choices.value, ...choices });
  }

  /** Cancels a running comparison and compares with `file`; the previous result stays until then. */
  async compare(file: SurfaceFile): Promise<void> {
    this.running.abort();
    if (file.size > maxBytes) {
      const size = (file.size / (1 << 20)).toFixed(1);
      const remedy = "record fewer times or fewer bodies, or compare on the command line (phrenic compare)";
      return this.fail(`${file.name} has ${size} MiB, but the server accepts less than 16: ${remedy}`);
    }
    const { signal } = this.begin(file.name);
    const content = await file.arrayBuffer().catch(() => undefined);
    if (signal.aborted) return;
    if (content === undefined) return this.fail(`${file.name} cannot be read: is it a file, and still there?`);
    this.file = { name: file.name, content: new Uint8Array(content) };
    return this.repeat();
  }

  /** Compares the same file with the current state. */
  async repeat(): Promise<void> {
    if (this.file === undefined) return;
    const { name } = this.file;
    const { signal } = this.begin(name);
    try {
      const found = await this.runComparison(signal, (done) =>
        this.progress.set({ kind: "running", file: name, done }),
      );
      if (signal.aborted) return;
      this.progress.set({ kind: "idle" });
      this.result.set(found);
    } catch (error) {
      if (!signal.aborted) this.fail(errorText(error));
    }
  }

  /** Cancels the running comparison; keeps the previous result. */
  stop(): void {
    this.running.abort();
    this.progress.set({ kind: "idle" });
  }

  /** Removes the file and the result. */
  clear(): void {
    this.stop();
    this.file = undefined;
    this.result.set(undefined);
  }

  /** Cancels the running comparison and starts another one. */
  private begin(file: string): AbortController {
    this.running.abort();
    this.running = new AbortController();
    this.progress.set({ kind: "running", file, done: 0 });
    return this.running;
  }

  private fail(message: string): void {
    this.progress.set({ kind: "failed", message });
  }

  private async runComparison(signal: AbortSignal, progress: (done: number) => void): Promise<Comparison> {
    let distances: number[] | undefined;
    let surface: Surface | undefined;
    for await (const { event } of this.call(signal)) {
      if (event.case === "progress" && !signal.aborted) progress(event.value);
      if (event.case === "vertices") distances = event.value.distances;
      if (event.case === "mesh") surface = surfaceOf(event.value);
      if (event.case === "table" && distances !== undefined) return { ...resultOf(event.value, distances), surface };
    }
    throw new Error("the server ended the comparison without a result");
  }

  private call(signal: AbortSignal): AsyncIterable<CompareResponse> {
    const { body, unitMm, time } = this.choices.value;
    const { name, content } = this.file!;
    return this.api.comparisons.compare(
      {
        a: { source: { case: "body", value: { sessionId: this.sessionId, body } } },
        b: { name, source: { case: "content", value: content }, unitMm, time },
        vertexDistances: true,
        meshOfB: true,
      },
      { signal },
    );
  }
}

function resultOf({ b, stateA, rows, warnings }: ComparisonTable, distances: number[]): Omit<Comparison, "surface"> {
  const distance = rows[0]?.distance;
  if (stateA === undefined || distance === undefined) throw new Error("the server sent an empty comparison");
  return { file: b, body: stateA.body, time: stateA.time, tick: stateA.tick, distance, warnings, distances };
}

function surfaceOf(mesh: ComparedMesh): Surface {
  const positions = floats(mesh.positions, 3, "mesh.positions");
  return { positions, triangles: indices(mesh.triangles, 3, positions.length / 3, "mesh.triangles") };
}
