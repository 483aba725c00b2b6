import { Measurements } from "../appearance/measurements";
import { vertexLabel } from "../appearance/tracked_vertices";
import { make } from "../dom/elements";
import type { Body, FrameArrays } from "../geometry/bodies";
import type { Marker, VertexRef } from "../geometry/vertices";
import { darkColor } from "../graphs/colors";
import { MeasurePanel, readingOf } from "../panels/view/measure_panel";
import { measurementsOf } from "../session/measured_links";
import type { Signal } from "../state/signal";
import type { Annotations } from "../viewer/annotations";
import type { SceneStructures } from "./scene_structures";

/** Movement of the cross by an arrow key, and with the shift key [CSS pixels]. */
const smallMove = 4;
const largeMove = 24;

const moves: Record<string, [number, number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};

/** Measuring in the scene: tools, labels, and a cross that picks points by keyboard. */
export class Measuring {
  readonly measurements: Measurements;
  readonly panel: MeasurePanel;
  /** The elements over the stage. */
  readonly overlays: HTMLElement[];
  private readonly cross = make("div", { id: "measure-cross", hidden: true });
  private place: [number, number] = [0, 0];

  /** `pickAt` picks the vertex at a place on the canvas [CSS pixels] as a click does. */
  constructor(
    private readonly canvas: HTMLElement,
    private readonly annotations: Annotations,
    bodies: () => Body[],
    structures: SceneStructures,
    private readonly pickAt: (x: number, y: number) => void,
  ) {
    this.measurements = new Measurements(bodies, (ref) => {
      const { body } = ref;
      return structures.at(ref) ?? { name: bodies().some((each) => each.name === body) ? body : vertexLabel(ref), body, vertices: undefined }; // prettier-ignore
    });
    this.panel = new MeasurePanel(this.measurements);
    this.overlays = [this.panel.hint, this.cross];
    this.cross.ariaHidden = "true";
    this.measurements.tool.subscribe((tool) => {
      canvas.classList.toggle("measuring", tool !== undefined);
      this.cross.hidden = true;
    });
    // Before the keys that move the camera.
    canvas.addEventListener("keydown", (event) => this.onKey(event), { capture: true });
  }

  /** Chooses the tool for distances and focuses the scene, so that its keys act. */
  start(): void {
    this.measurements.use("distance");
    this.canvas.focus();
  }

  /** Measures what an address asks for, or notes what is wrong with it. */
  measureAsLinked(address: URL, notice: Signal<string>): void {
    try {
      this.measurements.replaceKept(measurementsOf(address));
    } catch (error) {
      // The state of the session, which follows the scene at once, clears the notice.
      queueMicrotask(() => notice.set((error as Error).message));
    }
  }

  /** Takes a picked vertex. Returns false if no tool is active. */
  take(ref: VertexRef | undefined): boolean {
    if (this.measurements.tool.value === undefined) return false;
    if (ref !== undefined) this.measurements.pick(ref);
    return true;
  }

  /** Draws lines and labels for the displayed frame. */
  draw(arrays: FrameArrays): void {
    const { measurements } = this;
    const measured = measurements.all.value.map((each) => ({
      places: measurements.places(each.points, arrays),
      color: darkColor(each.id),
      label: readingOf(measurements, each, arrays).join(", "),
    }));
    const pending = { places: measurements.places(measurements.picked.value, arrays), color: "#ffffff", label: "" };
    this.annotations.setMeasured([...measured, pending]);
  }

  /** Returns markers of the measured and the picked points. */
  markers(arrays: FrameArrays): Marker[] {
    const { all, picked } = this.measurements;
    const groups = [...all.value.map(({ id, points }) => ({ points, color: darkColor(id) })), { points: picked.value, color: "#ffffff" }]; // prettier-ignore
    return groups.flatMap(({ points, color }) =>
      this.measurements.places(points, arrays).map((position) => ({ position, color })),
    );
  }

  private onKey(event: KeyboardEvent): void {
    if (this.measurements.tool.value === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    const move = moves[event.key] as [number, number] | undefined;
    if (event.key === "Enter" && !this.cross.hidden) this.pickAt(...this.place);
    else if (move !== undefined) this.moveCross(move, event.shiftKey ? largeMove : smallMove);
    else return;
    event.preventDefault();
    event.stopImmediatePropagation();
  }

  private moveCross([dx, dy]: [number, number], by: number): void {
    const { clientWidth, clientHeight } = this.canvas;
    if (this.cross.hidden) this.place = [clientWidth / 2, clientHeight / 2];
    this.cross.hidden = false;
    const [x, y] = this.place;
    this.place = [
      Math.min(clientWidth - 1, Math.max(0, x + by * dx)),
      Math.min(clientHeight - 1, Math.max(0, y + by * dy)),
    ];
    this.cross.style.transform = `translate(${this.place[0]}px, ${this.place[1]}px)`;
  }
}
