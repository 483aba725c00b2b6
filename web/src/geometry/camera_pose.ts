/** Where a camera is, and what it looks at [m]. */
export interface CameraPose {
  eye: { x: number; y: number; z: number };
  target: { x: number; y: number; z: number };
}
