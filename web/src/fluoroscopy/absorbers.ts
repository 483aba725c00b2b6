import { Placement } from "../gen/phrenic/v1/frames_pb";
import { type Body, floatsPerPose, type FrameArrays, positionsOf } from "../geometry/bodies";
import { enclosedVolume } from "../geometry/measuring";
import { computeNormals } from "../geometry/normals";
import { absorptionOf, isBone, lungCoefficient, lungDensity, materials, withoutLobesOfLungs } from "./attenuation";
import { closedTriangles } from "./closing";
import { trunkOutline } from "./outline";

/**
 * A closed surface that changes the attenuation coefficient by `weight` [1/m] from outside to inside. Along a ray, the
 * sum of weight times thickness over all surfaces is the line integral of the coefficient, also of surfaces in one
 * another.
 */
export interface Absorber {
  name: string;
  /** Positions [m]; before the pose, if there is one. */
  vertices: Float32Array<ArrayBuffer>;
  triangles: Uint32Array<ArrayBuffer>;
  weight: number;
  /** qx qy qz qw tx ty tz; undefined for positions in the patient frame. */
  pose: Float32Array | undefined;
  /** True if the positions change with frames. */
  moving: boolean;
}

/** A lung, and the density of its tissue and blood now [g/cm^3]. */
export interface LungNow {
  name: string;
  density: number;
}

/**
 * Thickness of the cortical shell of a rib [m]: with it a rib of this scene has the mean density of ribs, 1.4 g/cm^3.
 */
const shell = 0.0012;

/** What absorbs in a scene: its closed bodies with tissue, and an outline of the trunk that follows the bones. */
export class Absorbers {
  readonly all: Absorber[] = [];
  readonly lungs: LungNow[] = [];
  /** Bodies with tissue whose surfaces are open: they have no inside, and are left out. */
  readonly open: string[] = [];
  /** The middle of the lungs at rest, or of the bones without lungs [m]. */
  readonly isocentre: [number, number, number];
  private readonly parts: { body: Body; absorber: Absorber; restVolume: number; lung: LungNow | undefined }[] = [];
  private readonly bones: Body[];
  /** Coefficient of what is around the bodies [1/m]: tissue of the trunk, or nothing in scenes without bones. */
  private readonly outside: number;
  private readonly outline: Absorber;
  private readonly heights: [low: number, high: number];

  constructor(all: Body[]) {
    const bodies = withoutLobesOfLungs(all);
    this.bones = bodies.filter((body) => body.triangles.length > 0 && isBone(absorptionOf(body)));
    const outside = (this.outside = this.bones.length > 0 ? materials.wall.coefficient : 0);
    this.outline = {
      name: "trunk",
      vertices: none,
      triangles: noTriangles,
      weight: outside,
      pose: undefined,
      moving: true,
    };
    for (const seen of bodies.filter(({ triangles }) => triangles.length > 0)) {
      const absorption = absorptionOf(seen);
      if (absorption === undefined) continue;
      const triangles = closedTriangles(seen.rest, seen.triangles);
      const body = { ...seen, triangles: triangles ?? seen.triangles };
      if (triangles === undefined) this.open.push(body.name);
      else if (absorption === "rib") this.addRib(body);
      else if (absorption === "lung") this.add(body, 0, { name: body.name, density: 0 });
      else this.add(body, materials[absorption].coefficient - outside);
    }
    const lungs = bodies.filter((body) => absorptionOf(body) === "lung");
    this.isocentre = middleOf(lungs.length > 0 ? lungs : this.bones);
    const [low, high] = rangeOf(this.bones, 2);
    this.heights = [low, high];
    if (this.bones.length > 0) this.all.push(this.outline);
  }

  private add(body: Body, weight: number, lung?: LungNow): void {
    const absorber = absorberOf(body, body.rest, weight);
    this.all.push(absorber);
    if (lung !== undefined) this.lungs.push(lung);
    this.parts.push({ body, absorber, restVolume: enclosedVolume(body.rest, body.triangles), lung });
  }

  /** A rib is marrow in a shell of cortical bone. */
  private addRib(body: Body): void {
    const [cortical, marrow] = [materials.cortical.coefficient, materials.marrow.coefficient];
    this.add(body, cortical - this.outside);
    if (body.placement !== Placement.STREAMED) this.add({ ...body, rest: inset(body, shell) }, marrow - cortical);
  }

  /** Moves all to a frame. */
  update(frame: FrameArrays): void {
    for (const { body, absorber, restVolume, lung } of this.parts) {
      if (body.placement === Placement.RIGID) absorber.pose = poseIn(body, frame);
      if (body.placement === Placement.STREAMED) absorber.vertices = positionsOf(body, frame);
      if (lung === undefined) continue;
      const volume = enclosedVolume(absorber.vertices, body.triangles);
      lung.density = lungDensity(restVolume, volume);
      absorber.weight = lungCoefficient(restVolume, volume) - this.outside;
    }
    if (this.bones.length === 0) return;
    const bones = this.bones.map((body) => worldPositions(body, frame));
    Object.assign(this.outline, trunkOutline(bones, ...this.heights));
  }
}

const none = new Float32Array();
const noTriangles = new Uint32Array();

function absorberOf(body: Body, vertices: Float32Array<ArrayBuffer>, weight: number): Absorber {
  const moving = body.placement === Placement.STREAMED;
  return { name: body.name, vertices, triangles: body.triangles, weight, pose: undefined, moving };
}

/** Returns the rest positions moved inwards along the vertex normals [m]. */
function inset({ rest, triangles }: Body, by: number): Float32Array<ArrayBuffer> {
  const normals = new Float32Array(rest.length);
  computeNormals(rest, triangles, normals);
  return rest.map((each, i) => each - by * normals[i]);
}

const poseIn = ({ pose }: Body, { poses }: FrameArrays) =>
  poses.subarray(floatsPerPose * pose, floatsPerPose * (pose + 1));

function worldPositions(body: Body, frame: FrameArrays): Float32Array {
  if (body.placement === Placement.STREAMED) return positionsOf(body, frame);
  return body.placement === Placement.RIGID ? posed(body.rest, poseIn(body, frame)) : body.rest;
}

/** Returns positions in the patient frame: R(q) p + t. */
export function posed(vertices: Float32Array, pose: Float32Array | undefined): Float32Array {
  if (pose === undefined) return vertices;
  const [qx, qy, qz, qw, tx, ty, tz] = pose;
  const moved = new Float32Array(vertices.length);
  for (let i = 0; i < vertices.length; i += 3) {
    const [x, y, z] = [vertices[i], vertices[i + 1], vertices[i + 2]];
    const ux = 2 * (qy * z - qz * y);
    const uy = 2 * (qz * x - qx * z);
    const uz = 2 * (qx * y - qy * x);
    moved[i] = x + qw * ux + (qy * uz - qz * uy) + tx;
    moved[i + 1] = y + qw * uy + (qz * ux - qx * uz) + ty;
    moved[i + 2] = z + qw * uz + (qx * uy - qy * ux) + tz;
  }
  return moved;
}

function rangeOf(bodies: Body[], axis: number): [low: number, high: number] {
  let [low, high] = [Infinity, -Infinity];
  for (const { rest } of bodies) {
    for (let i = axis; i < rest.length; i += 3) [low, high] = [Math.min(low, rest[i]), Math.max(high, rest[i])];
  }
  return low > high ? [0, 0] : [low, high];
}

function middleOf(bodies: Body[]): [number, number, number] {
  const [x, y, z] = [0, 1, 2].map((axis) => rangeOf(bodies, axis)).map(([low, high]) => (low + high) / 2);
  return [x, y, z];
}
