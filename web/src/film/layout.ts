/** Frames per simulated second of a film. */
export const filmRate = 25;
/** The same of an animated picture, whose file has every picture whole. */
export const animationRate = 10;
/** Heights of films that a user may choose [lines of pixels], and the one that is chosen at first. */
export const filmLines = [360, 720, 1080];
export const usualLines = 720;

/** Largest width and height of a film [pixels]. */
export interface FilmSize {
  width: number;
  height: number;
}

/** Returns the size of films of this many lines: 16 to 9. */
export function filmSize(lines: number): FilmSize {
  return { width: (16 * lines) / 9, height: lines };
}

/** Of an animated picture: it is for pages and messages, where a film does not play. */
export const animationSize: FilmSize = { width: 480, height: 480 };

/** Height of the caption below the picture in a film of 720 lines, and the least one [pixels]. */
export const captionHeight = 64;
export const leastCaption = 48;

/**
 * Size of a film and of the picture in it [pixels], how much larger the picture is than the view it shows, and how much
 * larger the caption is than in a film of 720 lines.
 */
export interface FilmLayout {
  width: number;
  height: number;
  pictureHeight: number;
  scale: number;
  captionScale: number;
}

/**
 * Returns the layout of a film of a view of this size [CSS pixels]: as large as `most` allows, with even lengths, which
 * codecs need.
 */
export function filmLayout(width: number, height: number, most: FilmSize): FilmLayout {
  const caption = 2 * Math.round(Math.max(leastCaption, (captionHeight * most.height) / usualLines) / 2);
  const scale = Math.min(most.width / width, (most.height - caption) / height);
  const even = (length: number) => Math.max(2, 2 * Math.floor((length * scale + 1e-6) / 2));
  const pictureHeight = even(height);
  const captionScale = caption / captionHeight;
  return { width: even(width), height: pictureHeight + caption, pictureHeight, scale, captionScale };
}

/** Returns the times of the frames of a film of `length` [s]: from 0, `rate` a second, before the end. */
export function filmTimes(length: number, rate = filmRate): number[] {
  const count = Math.max(1, Math.round(length * rate));
  return Array.from({ length: count }, (_, i) => Math.min(i / rate, length));
}
