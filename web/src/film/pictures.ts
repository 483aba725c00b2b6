import type { DisplayedFrame } from "../frames/frame_buffer";
import { type Caption, drawCaption } from "./caption";
import { type FilmLayout, filmLayout, type FilmSize } from "./layout";

/** A rectangle [CSS pixels]. */
export interface Area {
  x: number;
  y: number;
  width: number;
  height: number;
}

/** The view that is filmed. */
export interface FilmStage {
  /** Returns why what is shown cannot be filmed; undefined if it can. */
  refusal(): string | undefined;
  /** The colours of the surface, for the caption. */
  colors(): Caption["colors"];
  /** The part of the view that is filmed. */
  area(): Area;
  background: string;
  /** Begins to draw frames of the film alone, with `ratio` pixels per CSS pixel. */
  begin(ratio: number): void;
  /** Draws a frame at once. The canvas has the picture only until the caller waits. */
  draw(frame: DisplayedFrame): HTMLCanvasElement;
  /** Ends the film; live frames are drawn again. */
  end(): void;
}

/** Drawn pixels per pixel of the film, which makes edges smooth, and most drawn pixels per CSS pixel. */
const oversampling = 1.5;
const maxRatio = 3;

/** Draws the pictures of a film, of the stage as it is now and at most as large as `most`, into one canvas. */
export class Pictures {
  readonly canvas: HTMLCanvasElement;
  private readonly area: Area;
  private readonly layout: FilmLayout;
  private readonly ratio: number;
  private readonly pen: CanvasRenderingContext2D;

  /** Throws Error if the browser gives no canvas of this size. */
  constructor(
    private readonly stage: FilmStage,
    private readonly caption: Caption,
    most: FilmSize,
  ) {
    this.area = stage.area();
    this.layout = filmLayout(this.area.width, this.area.height, most);
    this.ratio = Math.min(oversampling * this.layout.scale, maxRatio);
    const { width, height } = this.layout;
    this.canvas = Object.assign(document.createElement("canvas"), { width, height });
    const pen = this.canvas.getContext("2d");
    if (pen === null) throw new Error("the browser has no memory for a picture");
    this.pen = pen;
  }

  /** Prepares the stage. */
  begin(): void {
    this.stage.begin(this.ratio);
  }

  /** Draws a frame with its caption, which says `time` [s]. */
  take(frame: DisplayedFrame, time: number): void {
    const { pen, ratio, layout } = this;
    const picture = this.stage.draw(frame);
    const { x, y, width, height } = this.area;
    pen.fillStyle = this.stage.background;
    pen.fillRect(0, 0, layout.width, layout.height);
    pen.imageSmoothingQuality = "high";
    const [left, top, wide, high] = [x * ratio, y * ratio, width * ratio, height * ratio];
    pen.drawImage(picture, left, top, wide, high, 0, 0, layout.width, layout.pictureHeight);
    drawCaption(pen, this.caption, time, layout);
  }
}
