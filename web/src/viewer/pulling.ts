import * as THREE from "three";
import type { BodyView } from "./body_view";
import { dragPoint, pickVertex, pointerOf } from "./picking";

/** Called with the force on a vertex [N]; zero releases it. */
export type Pull = (body: string, vertex: number, force: [number, number, number]) => void;

/** Force per distance of the drag [N/m]. */
const stiffness = 40;

/**
 * Pulls the tissue under the pointer by dragging with the shift key. Beside the tissue the camera controls handle the
 * drag.
 */
export class Pulling {
  private readonly arrow = new THREE.ArrowHelper(new THREE.Vector3(0, 0, 1), new THREE.Vector3(), 1, "#ffd166");
  private held: { view: BodyView; vertex: number } | undefined;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly camera: THREE.Camera,
    scene: THREE.Scene,
    private readonly views: () => BodyView[],
    private readonly pull: Pull,
    private readonly changed: () => void,
    private readonly cut: () => THREE.Plane | undefined,
    /** Called with the force [N] and the pointer position; undefined on release. */
    private readonly onForce: (newtons: number | undefined, x: number, y: number) => void,
  ) {
    this.arrow.visible = false;
    // Drawn over everything, since the tissue may be behind bone.
    for (const part of [this.arrow.line, this.arrow.cone]) {
      part.renderOrder = 1;
      (part.material as THREE.Material).depthTest = false;
      (part.material as THREE.Material).transparent = true;
    }
    scene.add(this.arrow);
    // Handles the event before the camera controls.
    canvas.addEventListener("pointerdown", (event) => this.start(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const kind of ["pointerup", "pointercancel", "lostpointercapture"] as const) {
      canvas.addEventListener(kind, () => this.release());
    }
    window.addEventListener("pagehide", () => this.release());
  }

  private start(event: PointerEvent): void {
    if (!event.shiftKey || event.button !== 0) return;
    const views = this.views();
    const bodies = views.map((view) => ({ positions: view.positions.array, triangles: view.body.triangles }));
    const picked = pickVertex(pointerOf(event, this.canvas), this.camera, bodies, this.cut());
    if (picked === undefined) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    this.canvas.setPointerCapture(event.pointerId);
    this.held = { view: views[picked.body], vertex: picked.vertex };
    this.move(event);
  }

  private move(event: PointerEvent): void {
    if (this.held === undefined) return;
    const { view, vertex } = this.held;
    const place = new THREE.Vector3().fromBufferAttribute(view.positions, vertex);
    const way = dragPoint(pointerOf(event, this.canvas), this.camera, place).sub(place);
    this.drawArrow(place, way);
    const force = way.multiplyScalar(stiffness);
    this.onForce(force.length(), event.offsetX, event.offsetY);
    this.pull(view.body.name, vertex, [force.x, force.y, force.z]);
  }

  private drawArrow(from: THREE.Vector3, way: THREE.Vector3): void {
    const length = way.length();
    this.arrow.visible = length > 0;
    if (length === 0) return;
    this.arrow.position.copy(from);
    this.arrow.setDirection(way.clone().normalize());
    this.arrow.setLength(length, 0.2 * length, 0.1 * length);
    this.changed();
  }

  private release(): void {
    if (this.held === undefined) return;
    const { view, vertex } = this.held;
    this.held = undefined;
    this.arrow.visible = false;
    this.onForce(undefined, 0, 0);
    this.changed();
    this.pull(view.body.name, vertex, [0, 0, 0]);
  }
}
