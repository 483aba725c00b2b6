import { make } from "../dom/elements";
import type { Frame } from "../gen/phrenic/v1/frames_pb";
import type { Body, FrameArrays } from "../geometry/bodies";
import { Signal } from "../state/signal";
import { type Absorber, Absorbers } from "./absorbers";
import { angleName, type CArm, isMirrored, projectionOf } from "./c_arm";
import { explanationSection, pictureControls, type Settings } from "./controls";
import { projectOnProcessor } from "./cpu_projection";
import { GpuProjection } from "./gpu_projection";
import { drawMarks } from "./marks";
import { type SniffActions, SniffPanel } from "./sniff_panel";
import { svg } from "./svg";
import { paintSums, windowOf } from "./tone";
import { fixed, t } from "../language/translate";

/** Pixels of the picture each way: on a graphics card, where the processor draws for it, and where it computes all. */
const [fine, coarse, plain] = [768, 448, 144];
/** Step of the arrow keys [degrees]. */
const keyStep = 5;
/** Interval of updates of texts [ms]. */
const textInterval = 250;

/** What the fluoroscope needs from its page. */
export interface FluoroscopeParts {
  bodies: Body[];
  /** Returns the frame to show. */
  frame(): FrameArrays | undefined;
  /** True if the processor draws in place of a graphics card. */
  software: boolean;
  /** Asks for a call of `draw`. */
  redraw(): void;
  close(): void;
  /** Undefined for scenes without a preset for sniffs or without measured domes. */
  sniff: SniffActions | undefined;
}

/** A live projection of the scene by X-rays over the 3D view. */
export class Fluoroscope {
  readonly element = make("section", { id: "fluoroscopy", ariaLabel: t("Fluoroscopy") });
  private readonly canvas = make("canvas", { id: "fluoroscopy-picture", tabIndex: 0, role: "img" });
  private readonly overlay = svg("svg", { viewBox: "-1 -1 2 2", "aria-hidden": "true", class: "fluoroscopy-marks" });
  private readonly density = make("p", { id: "lung-density", className: "faint" });
  private readonly absorbers: Absorbers;
  private readonly settings: Settings = {
    arm: new Signal<CArm>({ lao: 0, cranial: 0, sourceToDetector: 1.8 }),
    window: new Signal<{ low: number; high: number } | undefined>(undefined),
    darkBones: new Signal(false),
    domes: new Signal(false),
  };
  private readonly gpu: GpuProjection | undefined;
  private readonly sniff: SniffPanel | undefined;
  private readonly diaphragm: Body | undefined;
  private manual = false;
  private texts = -Infinity;

  constructor(private readonly parts: FluoroscopeParts) {
    this.absorbers = new Absorbers(parts.bodies);
    this.diaphragm = parts.bodies.find(({ name }) => name === "diaphragm");
    this.gpu = GpuProjection.open(this.canvas, parts.software ? coarse : fine);
    const { arm, window, darkBones, domes } = this.settings;
    if (parts.sniff !== undefined) this.sniff = new SniffPanel(parts.sniff, () => this.showSniff());
    this.build();
    arm.subscribe(() => this.changeArm());
    window.subscribe((now) => (this.manual = now !== undefined));
    for (const each of [window, darkBones, domes]) (each as Signal<unknown>).subscribe(() => parts.redraw());
    this.canvas.addEventListener("keydown", (event) => this.onKey(event));
  }

  private build(): void {
    const close = make(
      "button",
      { type: "button", id: "fluoroscopy-close", title: t("Back to the 3D view (X)") },
      t("Close"),
    );
    close.onclick = () => this.parts.close();
    const heading = make("header", {}, make("h2", {}, t("Fluoroscopy")), close);
    const sniff = this.sniff === undefined ? [] : [this.sniff.element];
    const rest = [...pictureControls(this.settings), this.density, explanationSection(this.absorbers.open)];
    const controls = make(
      "div",
      { className: "fluoroscopy-controls", tabIndex: 0 },
      heading,
      this.note(),
      ...sniff,
      ...rest,
    );
    controls.role = "group";
    controls.ariaLabel = t("Controls of the fluoroscopy");
    const picture = make("div", { className: "fluoroscopy-frame" }, this.canvas);
    picture.append(this.overlay);
    this.element.append(picture, controls);
  }

  /** Says how exact the picture is where the graphics cannot add 32-bit numbers. */
  private note(): HTMLElement {
    const words =
      this.gpu === undefined
        ? `This browser's graphics cannot add floating-point numbers: the processor computes the picture, ${plain} × ${plain} pixels, with the same numbers.`
        : "This browser's graphics add numbers of 16 bits: greys have steps of about 1 %.";
    return make("p", { className: "fault", hidden: this.gpu?.format.words === "full" }, words);
  }

  /** Focuses the picture, so that its keys act. */
  focus(): void {
    this.canvas.focus();
  }

  /** Receives every frame. */
  receive(frame: Frame): void {
    this.sniff?.receive(frame);
  }

  /** Shows the present frame. */
  draw(): void {
    const frame = this.parts.frame();
    if (frame === undefined) return;
    this.absorbers.update(frame);
    const { arm, window, darkBones, domes } = this.settings;
    const projection = projectionOf(arm.value, this.absorbers.isocentre);
    const mirrored = isMirrored(arm.value);
    this.gpu?.project(this.absorbers.all, projection);
    const sums = this.gpu === undefined ? projectOnProcessor(this.absorbers.all, projection, plain) : undefined;
    if (window.value === undefined) {
      window.set(windowOf(sums ?? this.sums));
      this.manual = false;
    }
    const tone = { ...window.value!, darkBones: darkBones.value, mirrored };
    if (sums === undefined) this.gpu?.show(tone);
    else paintSums(this.canvas, sums, tone);
    const { diaphragm } = this;
    this.overlay.classList.toggle("dark-bones", darkBones.value);
    const result = this.sniff?.result;
    drawMarks(this.overlay, { arm: arm.value, projection, diaphragm, frame, domes: domes.value, result });
    this.updateTexts();
  }

  /** The line integrals of the present picture, row by row from the upper left. */
  get sums(): Float32Array {
    return this.gpu?.read() ?? projectOnProcessor(this.absorbers.all, this.projection, plain);
  }

  /** Returns the thickness of a surface around the origin [m] along the rays of a C-arm, as the picture computes it. */
  thickness(vertices: number[], triangles: number[], arm: CArm): Float32Array {
    const surface: Absorber = {
      name: "surface",
      vertices: new Float32Array(vertices),
      triangles: new Uint32Array(triangles),
      weight: 1,
      pose: undefined,
      moving: false,
    };
    const at = projectionOf(arm, [0, 0, 0]);
    if (this.gpu === undefined) return projectOnProcessor([surface], at, plain);
    this.gpu.project([surface], at);
    this.parts.redraw();
    return this.gpu.read();
  }

  /** Releases the graphics card's memory. */
  dispose(): void {
    this.gpu?.close();
    this.element.remove();
  }

  private get projection() {
    return projectionOf(this.settings.arm.value, this.absorbers.isocentre);
  }

  /** An automatic window follows the projection. */
  private changeArm(): void {
    const { arm, window } = this.settings;
    this.canvas.ariaLabel = t(
      "X-ray-like projection of the thorax, {0}. Arrow keys turn the C-arm.",
      t(angleName(arm.value)),
    );
    if (!this.manual) window.set(undefined);
    this.parts.redraw();
  }

  /** Shows both domes from the back to the front, as a sniff test is done. */
  private showSniff(): void {
    const { arm, domes } = this.settings;
    arm.set({ ...arm.value, lao: 0, cranial: 0 });
    domes.set(true);
  }

  private onKey(event: KeyboardEvent): void {
    const turn = turns[event.key] as [number, number] | undefined;
    if (turn === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    const { arm } = this.settings;
    const { lao, cranial } = arm.value;
    const clamped = (value: number, most: number) => Math.max(-most, Math.min(most, value));
    const next = { lao: clamped(lao + turn[0] * keyStep, 180), cranial: clamped(cranial + turn[1] * keyStep, 45) };
    arm.set({ ...arm.value, ...next });
    event.preventDefault();
  }

  private updateTexts(): void {
    if (performance.now() - this.texts < textInterval) return;
    this.texts = performance.now();
    const words = (name: string) => name.replace(/^lung-(right|left)$/, "$1 lung");
    const sides = this.absorbers.lungs.map(({ name, density }) => `${words(name)} ${fixed(density, 3)}`);
    this.density.textContent = sides.length === 0 ? "" : t("Density now [g/cm³]: {0}.", sides.join(", "));
    this.sniff?.draw();
  }
}

const turns: Record<string, [lao: number, cranial: number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};
