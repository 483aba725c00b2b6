import { forceOf, needsExact } from "../appearance/fields";
import { Ghosts } from "../appearance/ghosts";
import type { Looks } from "../appearance/layer_styles";
import { Painter } from "../appearance/vertex_colorizer";
import type { Api } from "../connection/api";
import { Connection, type Sink } from "../connection/session_connection";
import { make } from "../dom/elements";
import { Frames, longestWait } from "../frames/frame_buffer";
import type { Frame } from "../gen/phrenic/v1/frames_pb";
import { type Preset } from "../gen/phrenic/v1/scene_pb";
import { SessionState } from "../gen/phrenic/v1/session_pb";
import type { Body } from "../geometry/bodies";
import { PaneHeads } from "../panels/comparison/view_headers";
import { Forces, type Wanted } from "../session/force_queries";
import { Controller } from "../session/session_controller";
import type { Signal } from "../state/signal";
import type { Clock } from "../timing/clock";
import { Annotations } from "../viewer/annotations";
import { type Surroundings, Viewer } from "../viewer/viewer";
import type { SceneTools } from "./scene_tools";

/** Two that play and are this far apart or more [s] are brought together, after so many looks. */
const leastApart = 0.2;
const looksApart = 10;

/** What the picture beside shares with the first. */
export interface First {
  viewer: Viewer;
  frames: Frames;
  tools: SceneTools;
  looks: Looks;
  controller: Controller;
  presets: Signal<Preset[]>;
  around: Pick<Surroundings, "covered" | "calm">;
  /** Whether this viewer may play and pause it. */
  mayChange(): boolean;
}

/**
 * A second session in a picture of its own, with the first one's camera and looks: layers, colours and their scale, cut,
 * ghost and names. It plays and pauses with the first, in step.
 */
export class Beside {
  readonly element: HTMLElement;
  readonly heads: PaneHeads;
  private readonly viewer: Viewer;
  private readonly controller: Controller;
  private readonly connection: Connection;
  private readonly frames = new Frames();
  private readonly forces: Forces;
  private readonly painter: Painter;
  private readonly ghosts: Ghosts;
  private readonly annotations: Annotations;
  private leads = false;
  private apart = 0;

  constructor(
    api: Api,
    sessionId: string,
    private readonly first: First,
    private readonly clock: Clock,
    actions: { swap(): void; close(): void },
  ) {
    const canvas = make("canvas", { role: "img", ariaLabel: `The session ${sessionId}, in three dimensions` });
    this.controller = new Controller(api, sessionId, clock);
    first.controller.companion = this.controller;
    first.frames.goInStepWith(this.frames);
    this.heads = new PaneHeads([first.controller, this.controller], first.presets, actions);
    this.viewer = new Viewer(canvas, this.around());
    this.annotations = new Annotations(this.viewer);
    this.element = make("div", { id: "beside" }, canvas, this.annotations.element);
    this.forces = new Forces(api, sessionId);
    this.painter = new Painter(this.forces);
    this.ghosts = new Ghosts(this.viewer, () => this.frames.moment?.arrays, first.tools.ghost);
    this.connection = new Connection(api, sessionId, this.sink(), clock);
    this.letLead(canvas);
    this.share();
    void this.connection.run();
  }

  /** The first picture's camera has moved. */
  follow(): void {
    if (!this.leads) this.viewer.rig.follow(this.first.viewer.rig);
  }

  resize(): void {
    this.viewer.resize();
  }

  /** What both show at `now` [ms]. */
  tell(first: Frame | undefined, now: number): void {
    this.heads.tell([first, this.frames.lookedAt ?? this.frames.present(now)]);
    const [here, there] = [this.first.frames, this.frames].map(({ frame }) => frame?.time ?? 0);
    this.keepTogether(Math.abs(here - there));
  }

  /** Shows an earlier moment as the first does, or the present. */
  lookBack(time: number | undefined): void {
    this.frames.lookBack(time);
    this.forces.recall(time, this.wanted());
  }

  /** Has the server tell the forces that this picture is coloured by. */
  askForces(): void {
    const seen = `${this.frames.frame?.tick} ${this.controller.session.value?.revision}`;
    void this.forces.ask(this.wanted(), seen);
  }

  private wanted(): Wanted {
    const kind = forceOf(this.first.tools.coloring.kind.value);
    return { vertex: undefined, kind, bodies: kind === undefined ? [] : this.painter.names };
  }

  /** The camera is that of the picture that a person turned last. */
  private letLead(canvas: HTMLCanvasElement): void {
    const lead = (event: Event) => (this.leads = event.target === canvas);
    for (const kind of ["pointerdown", "wheel", "keydown"])
      document.addEventListener(kind, lead, { capture: true, passive: true });
  }

  /** Shows what the first picture shows, and how. */
  private share(): void {
    const { looks, tools } = this.first;
    const { coloring } = tools;
    looks.all.subscribe(() => this.look());
    tools.overlays.subscribe((shown) => this.viewer.showOverlays(shown));
    tools.labels.subscribe((on) => this.annotations.setLabels(on));
    tools.cut.subscribe((cut) => {
      this.viewer.setCut(cut);
      this.annotations.start(looks.all.value);
    });
    coloring.kind.subscribe((kind) => {
      this.connection.setExact(needsExact(kind));
      this.note();
    });
    coloring.scale.subscribe(() => this.paint());
    this.forces.sizes.subscribe(() => this.paint());
  }

  private around(): Surroundings {
    const { around, viewer } = this.first;
    return {
      ...around,
      advance: () => this.frames.advance(this.clock.now(), around.calm()),
      source: () => this.frames.moment?.arrays,
      update: () => {
        this.note();
        if (this.first.tools.coloring.kind.value !== undefined) this.paint();
      },
      drawn: () => {
        this.annotations.draw();
        if (this.leads) viewer.rig.follow(this.viewer.rig);
      },
    };
  }

  private sink(): Sink {
    return {
      link: () => undefined,
      session: (session, fresh) => this.controller.receive(session, fresh),
      scene: (bodies, report) => {
        const moving = new Set(report.bodies.filter(({ role }) => role === "deformable").map(({ name }) => name));
        this.show(bodies, moving);
      },
      basis: (basis) => this.frames.learn(basis),
      acknowledged: (response, sent, answered) => this.frames.acknowledged(response, sent, answered),
      frame: (frame) => {
        this.frames.receive(frame, this.clock.now());
        this.ghosts.receive(frame);
      },
    };
  }

  private show(bodies: Body[], moving: ReadonlySet<string>): void {
    const deformable = bodies.filter(({ name }) => moving.has(name));
    this.frames.start(bodies);
    this.viewer.show(bodies);
    this.painter.start(deformable);
    this.ghosts.start(deformable);
    this.follow();
    this.look();
  }

  private look(): void {
    const looks = this.first.looks.all.value;
    for (const { layer, opacity, visible } of looks) this.viewer.setLayerOpacity(layer, visible ? opacity : 0);
    this.annotations.start(looks);
  }

  private note(): void {
    const moment = this.frames.moment;
    if (moment !== undefined) this.painter.receive(moment.time, moment.arrays);
  }

  private paint(): void {
    const { kind, scale } = this.first.tools.coloring;
    this.viewer.paint(this.painter.paint(kind.value, scale.value));
  }

  /** Where others played them one by one, or the server began anew, two that play are not in step. */
  private keepTogether(apart: number): void {
    const { controller, mayChange } = this.first;
    const playing = [controller, this.controller].every(({ session }) => session.value?.state === SessionState.PLAYING);
    this.apart = playing && mayChange() && apart > leastApart && apart < longestWait ? this.apart + 1 : 0;
    if (this.apart < looksApart) return;
    this.apart = 0;
    void controller.gather();
  }
}
