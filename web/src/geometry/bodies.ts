import { type GetGeometryResponse, Placement } from "../gen/phrenic/v1/frames_pb";
import { floats, indices } from "./wire_arrays";

/** An action line [m]; `direction` is a unit vector. */
export interface ActionLine {
  name: string;
  origin: [number, number, number];
  direction: [number, number, number];
  radius: number;
  length: number;
}

/** The constant data of one body. Vertex indices are relative to the body. */
export interface Body {
  name: string;
  layer: string;
  layerTitle: string;
  color: string;
  opacity: number;
  placement: Placement;
  pose: number;
  firstVertex: number;
  /** Rest positions, x y z per vertex [m]. */
  rest: Float32Array<ArrayBuffer>;
  triangles: Uint32Array<ArrayBuffer>;
  edges: Uint32Array<ArrayBuffer>;
  rigidLinks: Uint32Array<ArrayBuffer>;
  attached: Uint32Array<ArrayBuffer>;
  fixed: Uint32Array<ArrayBuffer>;
  /** Vertices of a patient's body that were filled from the generated thorax; undefined for none. */
  template?: Uint32Array<ArrayBuffer> | undefined;
  actionLines: ActionLine[];
}

/** The arrays of a frame that move bodies. */
export interface FrameArrays {
  /** x y z per streamed vertex [m]. */
  positions: Float32Array<ArrayBuffer>;
  /** qx qy qz qw tx ty tz per rigid body [1, m]. */
  poses: Float32Array<ArrayBuffer>;
}

/** Numbers per pose: a quaternion and a translation. */
export const floatsPerPose = 7;

/** Decodes a body. Throws RangeError, naming the field, for arrays of wrong length or indices out of range. */
export function decodeBody(message: GetGeometryResponse): Body {
  const of = (field: string) => `${message.name}.${field}`;
  const rest = floats(message.restPositions, 3, of("rest_positions"));
  const count = rest.length / 3;
  return {
    name: message.name,
    layer: message.layer || message.name,
    layerTitle: message.layerTitle || message.layer || message.name,
    color: message.color || "#c8c8c8",
    opacity: message.opacity,
    placement: message.placement,
    pose: message.pose,
    firstVertex: message.firstVertex,
    rest,
    triangles: indices(message.triangles, 3, count, of("triangles")),
    edges: indices(message.edges, 2, count, of("edges")),
    rigidLinks: indices(message.rigidLinks, 2, count, of("rigid_links")),
    attached: indices(message.attachedVertices, 1, count, of("attached_vertices")),
    fixed: indices(message.fixedVertices, 1, count, of("fixed_vertices")),
    template: indices(message.templateVertices, 1, count, of("template_vertices")),
    actionLines: message.actionLines.map((line) => ({
      name: line.name,
      origin: triple(line.origin, of("action_lines.origin")),
      direction: triple(line.direction, of("action_lines.direction")),
      radius: line.radius,
      length: line.length,
    })),
  };
}

function triple(values: number[], what: string): [number, number, number] {
  if (values.length !== 3) throw new RangeError(`${what}: ${values.length} numbers instead of 3.`);
  return [values[0], values[1], values[2]];
}

/** Returns the positions of `body` in `frame` [m]. Throws RangeError if the frame is too short. */
export function positionsOf(body: Body, frame: FrameArrays): Float32Array<ArrayBuffer> {
  const first = 3 * body.firstVertex;
  const part = frame.positions.subarray(first, first + body.rest.length);
  if (part.length !== body.rest.length) throw new RangeError(`The frame ends before the vertices of ${body.name}.`);
  return part;
}

/** Returns the position of vertex `index` of `body` in `frame` [m]. */
export function vertexAt(body: Body, frame: FrameArrays, index: number): [number, number, number] {
  const source = body.placement === Placement.STREAMED ? positionsOf(body, frame) : body.rest;
  const point: [number, number, number] = [source[3 * index], source[3 * index + 1], source[3 * index + 2]];
  if (body.placement !== Placement.RIGID) return point;
  const pose = frame.poses.subarray(floatsPerPose * body.pose, floatsPerPose * (body.pose + 1));
  return transform(pose, point);
}

/** x = R(q) p + t. */
function transform(pose: Float32Array, [x, y, z]: [number, number, number]): [number, number, number] {
  const [qx, qy, qz, qw, tx, ty, tz] = pose;
  const ux = 2 * (qy * z - qz * y);
  const uy = 2 * (qz * x - qx * z);
  const uz = 2 * (qx * y - qy * x);
  return [
    x + qw * ux + (qy * uz - qz * uy) + tx,
    y + qw * uy + (qz * ux - qx * uz) + ty,
    z + qw * uz + (qx * uy - qy * ux) + tz,
  ];
}

/** Returns the number of vertices of the bodies. */
export function verticesOf(bodies: Body[]): number {
  return bodies.reduce((sum, { rest }) => sum + rest.length / 3, 0);
}

/** Returns the bodies that the scene does not hide; all if it hides all. */
export function shownAtFirst(bodies: Body[]): Body[] {
  const shown = bodies.filter(({ opacity }) => opacity > 0);
  return shown.length > 0 ? shown : bodies;
}
