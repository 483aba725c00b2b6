import type { FrameBuffer } from "../frames/frame_buffer";
import { type Body, vertexAt } from "../geometry/bodies";
import type { Viewer } from "../viewer/viewer";

/** What end-to-end tests read from the page as `window.phrenic`: numbers that pixels cannot give. Nothing acts on it. */
export interface TestHook {
  /** Tick and simulated time [s] of the newest frame; -1 before there is one. */
  tick(): number;
  time(): number;
  /** Pictures drawn since the page was opened. */
  drawCount(): number;
  /** When the first picture with a frame was drawn, since the page was asked for [ms]; -1 before. */
  firstDrawTime(): number;
  /** Names of the bodies, and a body's number of vertices. */
  bodies(): string[];
  vertices(body: string): number;
  /** Where a vertex is in the newest frame [m]. */
  vertex(body: string, index: number): [number, number, number];
  /** Where the camera is [m]. */
  eye(): [number, number, number];
}

declare global {
  interface Window {
    phrenic?: TestHook;
  }
}

export function testHook(bodies: () => Body[], frames: FrameBuffer, viewer: Viewer): TestHook {
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
    vertices: (body) => find(body).rest.length / 3,
    vertex: (body, index) => {
      if (frames.arrays === undefined) throw new RangeError("There is no frame yet.");
      return vertexAt(find(body), frames.arrays, index);
    },
  };
}
