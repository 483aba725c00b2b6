/** A body on the screen. */
export interface ScreenSurface {
  /** x, y [pixels of the result] and depth per vertex, larger is farther; NaN for vertices that are not shown. */
  places: Float32Array;
  /** Indices of the corners; a body without triangles shows its vertices. */
  triangles: ArrayLike<number>;
  /** False if what is behind it is seen through it. */
  opaque: boolean;
}

/** A pixel, the surface that is seen there, and the nearest corner of the triangle. */
export interface FrontVertex {
  x: number;
  y: number;
  surface: number;
  vertex: number;
}

/** Depth, surface and vertex per pixel. */
interface Layer {
  depth: Float32Array;
  surface: Int32Array;
  vertex: Int32Array;
}

/**
 * Returns which vertices are seen, by drawing the triangles with a depth buffer of few pixels: those of the front
 * opaque surface at each pixel, and those of the front transparent one before it.
 */
export function frontVertices(surfaces: ScreenSurface[], width: number, height: number): FrontVertex[] {
  const [opaque, transparent] = [layerOf(width * height), layerOf(width * height)];
  surfaces.forEach((each, i) => each.opaque && draw(each, i, opaque, width, height));
  transparent.depth.set(opaque.depth);
  surfaces.forEach((each, i) => each.opaque || draw(each, i, transparent, width, height));
  return [opaque, transparent].flatMap(({ surface, vertex }) => {
    const seen: FrontVertex[] = [];
    surface.forEach((of, i) => {
      if (of >= 0) seen.push({ x: i % width, y: Math.floor(i / width), surface: of, vertex: vertex[i] });
    });
    return seen;
  });
}

function layerOf(count: number): Layer {
  return {
    depth: new Float32Array(count).fill(Infinity),
    surface: new Int32Array(count).fill(-1),
    vertex: new Int32Array(count),
  };
}

function draw({ places, triangles }: ScreenSurface, of: number, layer: Layer, width: number, height: number): void {
  const put = (x: number, y: number, depth: number, vertex: number) => {
    const i = y * width + x;
    if (!(depth < layer.depth[i])) return;
    [layer.depth[i], layer.surface[i], layer.vertex[i]] = [depth, of, vertex];
  };
  if (triangles.length > 0) return drawTriangles(places, triangles, put, width, height);
  for (let i = 0; i < places.length; i += 3) {
    const [x, y] = [Math.floor(places[i]), Math.floor(places[i + 1])];
    if (x >= 0 && x < width && y >= 0 && y < height) put(x, y, places[i + 2], i / 3);
  }
}

type Put = (x: number, y: number, depth: number, vertex: number) => void;

/** Draws triangles at the centres of pixels. A comparison with NaN is false, so that what is not shown is skipped. */
function drawTriangles(p: Float32Array, triangles: ArrayLike<number>, put: Put, width: number, height: number): void {
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const [ax, ay, bx, by, cx, cy] = [p[a], p[a + 1], p[b], p[b + 1], p[c], p[c + 1]];
    const twice = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (!(twice !== 0)) continue;
    const top = Math.max(0, Math.ceil(Math.min(ay, by, cy) - 0.5));
    const bottom = Math.min(height - 1, Math.floor(Math.max(ay, by, cy) - 0.5));
    const first = Math.max(0, Math.ceil(Math.min(ax, bx, cx) - 0.5));
    const last = Math.min(width - 1, Math.floor(Math.max(ax, bx, cx) - 0.5));
    for (let y = top; y <= bottom; y++) {
      for (let x = first; x <= last; x++) {
        // Barycentric coordinates of the centre of the pixel.
        const [px, py] = [x + 0.5, y + 0.5];
        const u = ((px - ax) * (cy - ay) - (py - ay) * (cx - ax)) / twice;
        const v = ((bx - ax) * (py - ay) - (by - ay) * (px - ax)) / twice;
        if (!(u >= 0 && v >= 0 && u + v <= 1)) continue;
        const w = 1 - u - v;
        const corner = u >= v && u >= w ? b : v >= w ? c : a;
        put(x, y, w * p[a + 2] + u * p[b + 2] + v * p[c + 2], corner / 3);
      }
    }
  }
}
