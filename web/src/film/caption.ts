import type { ColorScale } from "../appearance/color_scale";
import { captionHeight, type FilmLayout } from "./layout";
import { decimal, fixed, t } from "../language/translate";

/** What the caption of a film says. */
export interface Caption {
  /** Scene and preset. */
  title: string;
  /** Name of the field that colours the surface, and its scale; undefined for the bodies' own colours. */
  colors: { label: string; scale: ColorScale } | undefined;
}

const disclaimer = "Research and teaching; not for clinical use";
const family = "system-ui, sans-serif";
const margin = 16;
const barWidth = 160;
const gap = 10;

/** Draws the caption for `time` [s] into the lowest part of a film of this layout. */
export function drawCaption(pen: CanvasRenderingContext2D, caption: Caption, time: number, layout: FilmLayout): void {
  const scale = layout.captionScale;
  pen.save();
  pen.translate(0, layout.pictureHeight);
  pen.scale(scale, scale);
  drawWords(pen, caption, time, layout.width / scale);
  pen.restore();
}

/** Draws the caption at the place and in the scale of a film of 720 lines that has this width. */
function drawWords(pen: CanvasRenderingContext2D, { title, colors }: Caption, time: number, width: number): void {
  pen.fillStyle = "#11161b";
  pen.fillRect(0, 0, width, captionHeight);
  pen.fillStyle = "#f1f4f7";
  pen.textBaseline = "middle";
  const clock = Math.min(90, width / 4);
  write(pen, title, margin, 21, { font: `600 19px ${family}`, room: width - 2 * margin - clock });
  write(pen, `${fixed(time, 2)} s`, width - margin, 21, {
    font: `600 19px ${family}`,
    room: clock,
    right: true,
  });
  const half = (width - 2 * margin) / 2;
  write(pen, t(disclaimer), width - margin, 46, { font: `13px ${family}`, room: half - gap, right: true });
  if (colors !== undefined) drawScale(pen, colors, 46, half);
}

function drawScale(
  pen: CanvasRenderingContext2D,
  { label, scale }: NonNullable<Caption["colors"]>,
  y: number,
  room: number,
): void {
  const bar = Math.min(barWidth, room / 3);
  const style = { font: `13px ${family}`, room: (room - bar - 2 * gap) / 2 };
  const words = `${label}  ${decimal(String(scale.low))}`;
  write(pen, words, margin, y, style);
  const left = margin + Math.min(pen.measureText(words).width, style.room) + gap;
  for (let x = 0; x < bar; x++) {
    pen.fillStyle = `rgb(${scale.color(scale.low + (x / bar) * (scale.top - scale.low)).join(" ")})`;
    pen.fillRect(left + x, y - 5, 1.5, 10);
  }
  pen.fillStyle = "#f1f4f7";
  write(pen, `${decimal(String(scale.top))} ${scale.unit}`, left + bar + gap, y, style);
}

function write(
  pen: CanvasRenderingContext2D,
  words: string,
  x: number,
  y: number,
  { font, room, right = false }: { font: string; room: number; right?: boolean },
): void {
  pen.font = font;
  pen.textAlign = right ? "right" : "left";
  pen.fillText(words, x, y, Math.max(1, room));
}
