import type { Api } from "../connection/api";
import { type Body, type FrameArrays, positionsOf } from "../geometry/bodies";
import { type AxisPlane, outlineOf, paintSection, type SectionPicture } from "../geometry/section";
import { TissueQueries } from "./tissue_queries";
import { type Place } from "./lattice";
import { Places, type TissueKind, type TissueState } from "./tissue_state";

/** Pixels of a section [m]. */
const sectionStep = 0.0015;

/** The lungs' tissue of one view: values on the lungs' surfaces and in a cut. */
export class LungTissue {
  readonly queries: TissueQueries;
  private bodies: Body[] = [];
  private places = new Map<string, Places>();
  private time = NaN;
  private states: TissueState[] = [];

  constructor(api: Api, sessionId: string) {
    this.queries = new TissueQueries(api, sessionId);
    this.queries.lungs.subscribe(() => this.places.clear());
    this.queries.readings.subscribe(() => (this.time = NaN));
  }

  /** Starts another scene. */
  start(bodies: Body[]): void {
    this.bodies = bodies;
    this.queries.start();
  }

  /** The bodies that show tissue; empty before the first query. */
  get lungBodies(): Body[] {
    const names = new Set(this.queries.lungs.value.map(({ name }) => name));
    return this.bodies.filter(({ name }) => names.has(name));
  }

  /** Sets the displayed time [s]. */
  receive(time: number): void {
    if (time === this.time) return;
    this.time = time;
    this.states = this.queries.at(time);
  }

  /** Returns a field on the vertices of a lung in its unit; undefined if the tissue is unknown at this time. */
  of(kind: TissueKind, body: Body): Float32Array | undefined {
    const state = this.stateOf(body.name);
    if (state === undefined) return undefined;
    let places = this.places.get(body.name);
    if (places === undefined) this.places.set(body.name, (places = new Places(state.lattice, body.rest)));
    return places.values(state.nodal(kind));
  }

  /** Paints the cut of each lung by a plane, as its surface is drawn in a frame. */
  sections(
    kind: TissueKind,
    plane: AxisPlane,
    arrays: FrameArrays,
    color: (value: number) => readonly [number, number, number],
  ): SectionPicture[] {
    return this.lungBodies.flatMap((body) => {
      const state = this.stateOf(body.name);
      if (state === undefined) return [];
      const outline = outlineOf(positionsOf(body, arrays), body.triangles, plane, sectionStep);
      if (outline === undefined) return [];
      const read = state.reader(kind);
      return [paintSection(outline, plane, sectionStep, (x, y, z) => color(read(x, y, z)))];
    });
  }

  /** Returns where the tissue that is at a point now [m] is at rest; undefined if it is unknown. */
  restOf(body: string, x: number, y: number, z: number): [number, number, number] | undefined {
    const state = this.stateOf(body);
    if (state === undefined) return undefined;
    const [dx, dy, dz] = state.displacementAt(state.placeOf(x, y, z));
    return [x - dx, y - dy, z - dz];
  }

  /** Returns where tissue is now that is at a point at rest [m]; undefined if it is unknown. */
  nowOf(lung: string, [x, y, z]: readonly [number, number, number]): [number, number, number] | undefined {
    const state = this.stateOf(lung);
    if (state === undefined) return undefined;
    const place: Place = state.lattice.place(x, y, z);
    const [dx, dy, dz] = state.displacementAt(place);
    return [x + dx, y + dy, z + dz];
  }

  private stateOf(name: string): TissueState | undefined {
    return this.states.find(({ lattice }) => lattice.name === name);
  }
}
