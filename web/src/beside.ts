import type { Api } from "./api";
import type { Clock } from "./clock";
import { Connection, type Sink } from "./connection";
import { Controller } from "./controller";
import { Frames } from "./frames";
import type { Frame } from "./gen/phrenic/v1/frames_pb";
import type { Parameters } from "./gen/phrenic/v1/parameters_pb";
import type { Preset } from "./gen/phrenic/v1/scene_pb";
import { isDome } from "./graphs/catalogue";
import type { Looks } from "./looks";
import { formatNumber } from "./numbers";
import { make } from "./panels/dom";
import { labelOf, presetOf } from "./panels/presets";
import { parameterControls } from "./schema";
import type { Signal } from "./signal";
import { type Surroundings, Viewer } from "./viewer/viewer";

/** What the picture beside shares with the first. */
export interface First {
  viewer: Viewer;
  looks: Looks;
  controller: Controller;
  presets: Signal<Preset[]>;
  around: Pick<Surroundings, "covered" | "calm">;
}

/** A second session in a picture of its own, with the first one's camera and looks; it plays and pauses with the first. */
export class Beside {
  readonly element: HTMLElement;
  /** What the first picture is headed by. */
  readonly firstHead: HTMLElement;
  /** Each is named by how it breathes, where a preset says that; else by its session. */
  private readonly names = [make("b"), make("b")];
  private readonly descents = [make("span", { className: "domes" }), make("span", { className: "domes" })];
  private readonly viewer: Viewer;
  private readonly controller: Controller;
  private readonly frames = new Frames();
  private leads = false;
  private readonly time = make("span");
  private readonly differences = make("p", { className: "differences" });

  constructor(
    api: Api,
    sessionId: string,
    private readonly first: First,
    private readonly clock: Clock,
    actions: { swap(): void; close(): void },
  ) {
    const canvas = make("canvas", { role: "img", ariaLabel: `The session ${sessionId}, in three dimensions` });
    const swap = make(
      "button",
      { type: "button", className: "small", title: "Controls act on this one then" },
      "Steer",
    );
    swap.onclick = () => actions.swap();
    const close = make("button", { type: "button", className: "small", ariaLabel: `Close ${sessionId}` }, "Close");
    close.onclick = () => actions.close();
    const [here, there] = this.names;
    const head = make(
      "div",
      { className: "pane-head", title: sessionId },
      there,
      this.time,
      swap,
      close,
      this.descents[1],
    );
    const steered = make("span", {}, "steered");
    this.firstHead = make(
      "div",
      { className: "pane-head", title: first.controller.sessionId },
      here,
      steered,
      this.descents[0],
    );
    this.element = make("div", { id: "beside" }, canvas, head, this.differences);
    this.viewer = new Viewer(canvas, {
      ...first.around,
      advance: () => this.frames.advance(this.clock.now(), first.around.calm()),
      source: () => this.frames.moment?.arrays,
      drawn: () => {
        if (this.leads) first.viewer.rig.follow(this.viewer.rig);
      },
    });
    // The camera is that of the picture that a person turned last.
    const lead = (event: Event) => (this.leads = event.target === canvas);
    for (const kind of ["pointerdown", "wheel", "keydown"])
      document.addEventListener(kind, lead, { capture: true, passive: true });
    this.controller = new Controller(api, sessionId, clock);
    first.controller.companion = this.controller;
    this.controller.session.subscribe(() => this.compare());
    first.controller.session.subscribe(() => this.compare());
    first.presets.subscribe(() => this.compare());
    first.looks.all.subscribe(() => this.look());
    void new Connection(api, sessionId, this.sink(), clock).run();
  }

  /** The first picture's camera has moved. */
  follow(): void {
    if (!this.leads) this.viewer.rig.follow(this.first.viewer.rig);
  }

  resize(): void {
    this.viewer.resize();
  }

  private sink(): Sink {
    return {
      link: () => undefined,
      session: (session, fresh) => this.controller.receive(session, fresh),
      scene: (bodies) => {
        this.frames.start(bodies);
        this.viewer.show(bodies);
        this.follow();
        this.look();
      },
      acknowledged: (response, sent, answered) => this.frames.acknowledged(response, sent, answered),
      frame: (frame) => {
        this.frames.receive(frame, this.clock.now());
        this.time.textContent = `${frame.time.toFixed(2)} s`;
      },
    };
  }

  /** How far the domes of both have come down by now. */
  tell(first: Frame | undefined): void {
    [first, this.frames.frame].forEach((frame, i) => (this.descents[i].textContent = domeWords(frame)));
  }

  private look(): void {
    for (const { layer, opacity, visible } of this.first.looks.all.value)
      this.viewer.setLayerOpacity(layer, visible ? opacity : 0);
  }

  private compare(): void {
    const [here, there] = [this.first.controller, this.controller].map(({ session }) => session.value?.parameters);
    const words = differences(here, there);
    [this.first.controller, this.controller].forEach(({ session, sessionId }, i) => {
      const preset = presetOf(this.first.presets.value, session.value?.parameters);
      this.names[i].textContent = preset === undefined ? sessionId : labelOf(preset);
    });
    this.differences.textContent = words === "" ? "The same parameters" : words;
  }
}

/** "right dome 19.5 mm down, left dome 2.1 mm up"; empty where the scene has no probe of a dome. */
export function domeWords(frame: Frame | undefined): string {
  return (frame?.probes ?? [])
    .filter(isDome)
    .map(({ name, dz }) => `${name} ${(1000 * Math.abs(dz)).toFixed(1)} mm ${dz > 0 ? "up" : "down"}`)
    .join(", ");
}

/** What is set otherwise in `there`: "Breath force 2 instead of 1". */
export function differences(here: Parameters | undefined, there: Parameters | undefined): string {
  if (here === undefined || there === undefined) return "";
  const values = (of: Parameters) => of as unknown as Record<string, number | boolean>;
  return parameterControls()
    .filter(({ field }) => values(here)[field] !== values(there)[field])
    .map((control) => {
      const words = (value: number | boolean) => {
        if (typeof value === "boolean") return value ? "on" : "off";
        const named = control.kind === "choice" ? control.options.find((each) => each.value === value) : undefined;
        return named?.label ?? formatNumber(value);
      };
      return `${control.label} ${words(values(there)[control.field])} instead of ${words(values(here)[control.field])}`;
    })
    .join(", ");
}
