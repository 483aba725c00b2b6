import type { Api } from "../connection/api";
import { SampleFeed } from "../connection/sample_feed";
import type { Frame } from "../gen/phrenic/v1/frames_pb";
import type { Preset } from "../gen/phrenic/v1/scene_pb";
import type { SessionController } from "../session/session_controller";
import type { Signal } from "../state/signal";
import type { Clock } from "../timing/clock";
import { SessionReferences } from "./session_references";

/**
 * When the graphs begin: after the first drawing, which they would delay; in a tab that is not drawn, after the start
 * [ms].
 */
const afterFirstDrawing = 500;
const latest = 15_000;

/** What the graphs of a session need. */
export interface NumbersListener {
  /** Records the numbers of a sample; `present`: of the state when reading began, between two samples. */
  record(numbers: Frame, present: boolean): void;
  /** Samples before the next one are missing. */
  gap(): void;
  /** Why the numbers cannot be read; empty if they can. */
  refused(reason: string): void;
  /** The ranges of health or the static curves have changed. */
  referencesChanged(): void;
}

/** The samples of a session's measures, and what graphs show beside them. */
export class SessionNumbers {
  readonly references: SessionReferences;
  private readonly samples: SampleFeed;
  private newest: Frame | undefined;
  private follows = false;
  private drawn = false;

  constructor(
    api: Api,
    private readonly controller: SessionController,
    presets: Signal<Preset[]>,
    private readonly listener: NumbersListener,
    clock: Clock,
  ) {
    const feed = {
      sample: (numbers: Frame, present: boolean) => this.record(numbers, present),
      gap: () => listener.gap(),
      refused: (reason: string) => listener.refused(reason),
    };
    this.samples = new SampleFeed(api, controller.sessionId, feed, clock);
    this.references = new SessionReferences(api, controller, presets, () => listener.referencesChanged(), clock);
  }

  /** Begins to read, at the latest some seconds from now. */
  start(): void {
    this.controller.session.subscribe(() => this.samples.wake());
    setTimeout(() => this.follow(), latest);
  }

  /** To be called after each drawing of the scene: begins to read soon after the first. */
  afterDraw(): void {
    if (this.drawn) return;
    this.drawn = true;
    setTimeout(() => this.follow(), afterFirstDrawing);
  }

  /** Records the newest sample for a scene that has come: the first of a session that rests may have come before it. */
  recordNewest(): void {
    if (this.newest !== undefined) this.listener.record(this.newest, true);
  }

  /** Reads what has come since the last sample. */
  catchUp(): Promise<void> {
    return this.samples.catchUp();
  }

  private follow(): void {
    if (this.follows) return;
    this.follows = true;
    void this.samples.run();
    this.references.start();
  }

  private record(numbers: Frame, present: boolean): void {
    this.newest = numbers;
    this.listener.record(numbers, present);
  }
}
