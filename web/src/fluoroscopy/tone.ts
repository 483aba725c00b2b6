import type { Tone } from "./gpu_projection";

/** Line integrals below this are those of rays beside the trunk. */
const beside = 0.4;
/** Parts of the picture's rays through the trunk that may be black and white. */
const [darkest, brightest] = [0.06, 0.98];
/** A window has at least this width, so that a picture of one thickness is one grey. */
const narrowest = 0.2;

/**
 * Returns the window in which nearly all rays through the trunk are grey: what radiologists set, from lung to spine.
 */
export function windowOf(sums: Float32Array): { low: number; high: number } {
  const through = sums.filter((each) => each > beside).sort();
  if (through.length === 0) return { low: 0, high: 1 };
  const at = (part: number) => through[Math.min(through.length - 1, Math.floor(part * through.length))];
  const [low, high] = [at(darkest), at(brightest)];
  return high - low >= narrowest ? { low, high } : { low: low - narrowest / 2, high: low + narrowest / 2 };
}

/** Returns the grey of a line integral, 0 to 255, as the graphics card shows it. */
export function greyOf(sum: number, { low, high, darkBones }: Omit<Tone, "mirrored">): number {
  const grey = Math.min(1, Math.max(0, (sum - low) / (high - low)));
  return Math.round(255 * (darkBones ? 1 - grey : grey));
}

/** Draws line integrals in grey, for browsers whose graphics cannot. */
export function paintSums(canvas: HTMLCanvasElement, sums: Float32Array, tone: Tone): void {
  const size = Math.round(Math.sqrt(sums.length));
  Object.assign(canvas, { width: size, height: size });
  const image = new ImageData(size, size);
  for (let i = 0; i < sums.length; i++) {
    const column = i % size;
    const from = tone.mirrored ? i - column + (size - 1 - column) : i;
    image.data.fill(greyOf(sums[from], tone), 4 * i, 4 * i + 3);
    image.data[4 * i + 3] = 255;
  }
  canvas.getContext("2d")?.putImageData(image, 0, 0);
}
