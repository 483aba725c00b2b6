import type { Fluoroscope } from "../fluoroscopy/fluoroscope";
import type { FrameBuffer } from "../frames/frame_buffer";
import { type Body, vertexAt } from "../geometry/bodies";
import type { Viewer } from "../viewer/viewer";

/** Read-only values that end-to-end tests read from `window.phrenic`, since pixels do not show them. */
export interface TestHook {
  /** Tick and simulated time [s] of the newest frame; -1 before the first one. */
  tick(): number;
  time(): number;
  /** Number of drawings since the page was opened. */
  drawCount(): number;
  /** Time of the first drawing that shows a frame, since navigation start [ms]; -1 before. */
  firstDrawTime(): number;
  /** Names of the bodies, and the number of vertices of a body. Throws RangeError for an unknown body. */
  bodies(): string[];
  vertices(body: string): number;
  /** Position of a vertex in the newest frame [m]. */
  vertex(body: string, index: number): [number, number, number];
  /** Camera position [m]. */
  eye(): [number, number, number];
  /** True while the camera flies to a view. */
  flying(): boolean;
  /** The picture by X-rays; undefined while it is not shown. */
  fluoroscopy(): Pick<Fluoroscope, "sums" | "thickness"> | undefined;
}

declare global {
  interface Window {
    phrenic?: TestHook;
  }
}

/** Returns the hook of a page. */
export function testHook(
  bodies: () => Body[],
  frames: FrameBuffer,
  viewer: Viewer,
  fluoroscopy: TestHook["fluoroscopy"],
): TestHook {
  const find = (name: string) => {
    const body = bodies().find((each) => each.name === name);
    if (body === undefined) throw new RangeError(`There is no body "${name}".`);
    return body;
  };
  return {
    tick: () => Number(frames.frame?.tick ?? -1),
    time: () => frames.frame?.time ?? -1,
    drawCount: () => viewer.drawCount,
    firstDrawTime: () => viewer.firstDrawTime,
    bodies: () => bodies().map((body) => body.name),
    eye: () => {
      const { x, y, z } = viewer.rig.pose.eye;
      return [x, y, z];
    },
    flying: () => viewer.rig.flying,
    fluoroscopy,
    vertices: (body) => find(body).rest.length / 3,
    vertex: (body, index) => {
      if (frames.arrays === undefined) throw new RangeError("There is no frame yet.");
      return vertexAt(find(body), frames.arrays, index);
    },
  };
}
