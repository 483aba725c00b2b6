/** Frames per simulated second of a film. */
export const filmRate = 25;
/** The same of an animated picture, whose file has every picture whole. */
export const animationRate = 10;
/** Largest width and height of a film, and height of the caption below the picture [pixels]. */
const maxWidth = 1280;
const maxHeight = 720;
export const captionHeight = 64;

/** Size of a film and of the picture in it [pixels], and how much larger the picture is than the view it shows. */
export interface FilmLayout {
  width: number;
  height: number;
  pictureHeight: number;
  scale: number;
}

/**
 * Returns the layout of a film of a view of this size [CSS pixels]: as large as the largest film allows, with even
 * lengths, which codecs need.
 */
export function filmLayout(width: number, height: number): FilmLayout {
  const scale = Math.min(maxWidth / width, (maxHeight - captionHeight) / height);
  const even = (length: number) => Math.max(2, 2 * Math.floor((length * scale + 1e-6) / 2));
  const pictureHeight = even(height);
  return { width: even(width), height: pictureHeight + captionHeight, pictureHeight, scale };
}

/** Returns the times of the frames of a film of `length` [s]: from 0, `rate` a second, before the end. */
export function filmTimes(length: number, rate = filmRate): number[] {
  const count = Math.max(1, Math.round(length * rate));
  return Array.from({ length: count }, (_, i) => Math.min(i / rate, length));
}
