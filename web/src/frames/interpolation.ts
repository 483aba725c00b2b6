import { floatsPerPose, type FrameArrays } from "../geometry/bodies";

/** Interpolates between two frames, `part` from 0 to 1: positions linearly, orientations along the shorter arc. */
export function interpolate(a: FrameArrays, b: FrameArrays, part: number): FrameArrays {
  if (part <= 0 || a === b) return a;
  if (part >= 1) return b;
  const poses = lerp(a.poses, b.poses, part);
  for (let at = 0; at < poses.length; at += floatsPerPose) nlerp(a.poses, b.poses, part, at, poses);
  return { positions: lerp(a.positions, b.positions, part), poses };
}

function lerp(a: Float32Array, b: Float32Array, part: number): Float32Array<ArrayBuffer> {
  const result = new Float32Array(a.length);
  for (let i = 0; i < a.length; i++) result[i] = a[i] + part * (b[i] - a[i]);
  return result;
}

/** Normalised linear interpolation of the quaternion at `at`; accurate since rotations between two frames are small. */
function nlerp(a: Float32Array, b: Float32Array, part: number, at: number, out: Float32Array): void {
  let dot = 0;
  for (let k = at; k < at + 4; k++) dot += a[k] * b[k];
  const sign = dot < 0 ? -1 : 1;
  let squares = 0;
  for (let k = at; k < at + 4; k++) {
    out[k] = (1 - part) * a[k] + part * sign * b[k];
    squares += out[k] ** 2;
  }
  for (let k = at; k < at + 4; k++) out[k] /= Math.sqrt(squares) || 1;
}
