/** Position of a camera and the point that it looks at [m]. */
export interface CameraPose {
  eye: { x: number; y: number; z: number };
  target: { x: number; y: number; z: number };
}
