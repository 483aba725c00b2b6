/** Where a camera is, and what it looks at [m]. */
export interface Pose {
  eye: { x: number; y: number; z: number };
  target: { x: number; y: number; z: number };
}
