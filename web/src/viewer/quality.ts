/** What a picture may cost: "full" with shadows, "balanced" with the light of a room, "plain" for slow machines. */
export const qualities = ["plain", "balanced", "full"] as const;
/** What a picture may cost. */
export type Quality = (typeof qualities)[number];

/** Interval above which an animation frame is slow [ms], and slow frames in a row before the quality is reduced. */
const slowInterval = 36;
const maxSlowFrames = 12;

/**
 * Chooses the quality of the picture. It starts full, or plain where the processor draws in place of a graphics card,
 * and goes one step down after slow frames. It does not go up again, so that the picture does not alternate.
 */
export class QualityChooser {
  private automatic: Quality;
  private slowFrames = 0;
  private lastFrame = -Infinity;
  private lastDrew = false;

  /** `fixed` is the choice of the user; undefined to choose by the measured time. */
  constructor(
    software: boolean,
    public fixed?: Quality,
  ) {
    this.automatic = software ? "plain" : "full";
  }

  /** The quality of the next drawing. */
  get quality(): Quality {
    return this.fixed ?? this.automatic;
  }

  /** Records an animation frame at `now` [ms] and whether it is drawn. Returns true if `quality` changes. */
  recordFrame(now: number, draws: boolean): boolean {
    const interval = now - this.lastFrame;
    const steady = draws && this.lastDrew;
    [this.lastFrame, this.lastDrew] = [now, draws];
    if (!steady || this.fixed !== undefined) return false;
    this.slowFrames = interval > slowInterval ? this.slowFrames + 1 : 0;
    const step = qualities.indexOf(this.automatic);
    if (this.slowFrames < maxSlowFrames || step === 0) return false;
    this.slowFrames = 0;
    this.automatic = qualities[step - 1];
    return true;
  }
}

/**
 * Least time between two drawings where the processor draws in place of a graphics card [ms]. Fifteen pictures a second
 * leave it time for the rest of the page, and for a server on the same machine.
 */
const softwareInterval = 60;

/** Spaces drawings where the processor draws. */
export class Pace {
  private lastDrawn = -Infinity;

  constructor(private readonly software: boolean) {}

  /** True if a drawing may start at `now` [ms]; requires that one is due, and records it. */
  starts(now: number): boolean {
    if (this.software && now - this.lastDrawn < softwareInterval) return false;
    this.lastDrawn = now;
    return true;
  }
}

/** True if the processor draws in place of a graphics card. */
export function drawsInSoftware(): boolean {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (gl === null) return false;
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(names === null ? gl.RENDERER : names.UNMASKED_RENDERER_WEBGL));
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return isSoftwareRenderer(name);
}

/** True if a renderer of this name is software. */
export function isSoftwareRenderer(name: string): boolean {
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}
