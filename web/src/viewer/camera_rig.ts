import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { CameraPose } from "../geometry/camera_pose";
import { flightAt } from "./flight";
import {
  directionLetter,
  fitted,
  type FreeArea,
  openingView,
  type Outlook,
  planeAxes,
  type Side,
  viewDirection,
  type ViewName,
} from "./named_views";

/** The orientation and scale of a view. */
export interface ViewOrientation {
  left: string;
  right: string;
  top: string;
  bottom: string;
  /** CSS pixels per metre at the centre of the scene. */
  pixelsPerMetre: number;
  /** Unit vectors to the right, up and towards the camera. */
  axes: [THREE.Vector3, THREE.Vector3, THREE.Vector3];
}

/** Parts of the canvas that panels cover at its edges [CSS pixels]. */
export interface Insets {
  left: number;
  top: number;
  bottom: number;
  /** Room left and right of the scene, beside what panels cover. Not set: none. */
  sides?: number;
}

/** Duration of a flight to another view [ms]. */
const flightDuration = 700;
/** Fraction of the free area that a single structure fills. */
const closeness = 0.62;
/** Fraction of the distance to the remote camera that remains after one frame. */
const chaseRemainder = 0.7;

/** The camera and its controls: orbit, zoom, pan, and transitions to named views. */
export class CameraRig {
  readonly camera = new THREE.PerspectiveCamera(26, 1, 0.01, 100);
  private readonly controls: OrbitControls;
  private points: THREE.Vector3[] = [];
  private center = new THREE.Vector3();
  private homeView: Side = "home";
  private freeArea: FreeArea = { width: 1, height: 1 };
  /** The named view that the camera shows or moves to; undefined after the user moved it. */
  private namedView: ViewName | undefined;
  private extent = 1;
  private flat = false;
  private remotePose: CameraPose | undefined;
  /** What the camera showed before it flew to a structure. */
  private before: { outlook: Outlook; view: ViewName | undefined } | undefined;
  private flight: { from: Outlook; to: Outlook; start: number } | undefined;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly onChange: () => void,
    private readonly reducedMotion: () => boolean,
  ) {
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = !reducedMotion();
    this.controls.dampingFactor = 0.12;
    this.controls.addEventListener("change", onChange);
    this.controls.addEventListener("start", () => (this.flight = this.namedView = this.remotePose = undefined));
  }

  /** Fits the camera to a new scene; `points` is a sample of its vertices, `caged` is true if it has a rib cage. */
  frame(points: THREE.Vector3[], caged: boolean): void {
    const box = new THREE.Box3().setFromPoints(points);
    this.points = points;
    this.center = box.getCenter(new THREE.Vector3());
    const size = box.getSize(new THREE.Vector3()).length() || 1;
    this.extent = size;
    this.camera.near = size / 100;
    this.camera.far = size * 20;
    this.controls.minDistance = size / 20;
    this.controls.maxDistance = size * 8;
    this.homeView = openingView(box, caged);
    this.flat = planeAxes(box) !== undefined;
    this.goTo("home", true);
  }

  /** Moves to a named view. */
  goTo(view: ViewName, atOnce = this.reducedMotion()): void {
    const side = view === "home" ? this.homeView : view;
    this.flyTo(fitted(viewDirection(side), this.points, this.camera, this.roomyArea()), atOnce);
    this.before = undefined;
    this.namedView = view;
  }

  /** Moves to where `points` fill the free area, looking in the same direction as now. */
  lookAt(points: THREE.Vector3[], atOnce = this.reducedMotion()): void {
    const away = this.camera.position.clone().sub(this.controls.target).normalize();
    const { width, height } = this.freeArea;
    const free = { width: closeness * width, height: closeness * height };
    if (points.length === 0) return;
    this.before ??= { outlook: this.flight?.to ?? this.outlook, view: this.namedView };
    this.flyTo(fitted(away, points, this.camera, free), atOnce);
  }

  /** Moves back to where the camera was before `lookAt`. */
  flyBack(atOnce = this.reducedMotion()): void {
    const { before } = this;
    this.before = undefined;
    if (before?.view !== undefined) this.goTo(before.view, atOnce);
    else if (before !== undefined) this.flyTo(before.outlook, atOnce);
  }

  private flyTo(to: Outlook, atOnce: boolean): void {
    this.namedView = this.remotePose = this.flight = undefined;
    if (atOnce) this.show(to);
    else this.flight = { from: this.outlook, to, start: performance.now() };
    this.onChange();
  }

  private show({ eye, target }: Outlook): void {
    this.camera.position.copy(eye);
    this.controls.target.copy(target);
  }

  private get outlook(): Outlook {
    return { eye: this.camera.position.clone(), target: this.controls.target.clone() };
  }

  /** A planar scene needs room for its axes. */
  private roomyArea(): FreeArea {
    const air = this.flat ? 0.84 : 1;
    return { width: air * this.freeArea.width, height: air * this.freeArea.height };
  }

  /** Centres the scene in the part of the canvas that panels do not cover. */
  resize({ left, top, bottom, sides = 0 }: Insets): void {
    const width = Math.max(this.canvas.clientWidth, 1);
    const height = Math.max(this.canvas.clientHeight, 1);
    this.freeArea = {
      width: Math.max(0.3, 1 - (left + 2 * sides) / width),
      height: Math.max(0.3, 1 - (top + bottom) / height),
    };
    this.camera.aspect = width / height;
    this.camera.setViewOffset(width, height, -left / 2, (bottom - top) / 2, width, height);
    this.camera.updateProjectionMatrix();
    if (this.namedView !== undefined) this.goTo(this.namedView, true);
  }

  /** True while the camera flies to a view. */
  get flying(): boolean {
    return this.flight !== undefined;
  }

  /** Centre of the scene at rest [m]. */
  get sceneCenter(): THREE.Vector3 {
    return this.center;
  }

  /** Distance from the camera to its target, and the extent of the scene [m]. */
  get depth(): { distance: number; extent: number } {
    return { distance: this.camera.position.distanceTo(this.controls.target), extent: this.extent };
  }

  /** Projects a point [m] to the canvas [CSS pixels]. */
  project(point: THREE.Vector3): [x: number, y: number] {
    const { x, y } = point.clone().project(this.camera);
    return [((x + 1) / 2) * this.canvas.clientWidth, ((1 - y) / 2) * this.canvas.clientHeight];
  }

  /** Copies the camera of another view of the same scene. */
  copyFrom({ camera, controls }: CameraRig): void {
    const apart = this.camera.position.distanceTo(camera.position) + this.controls.target.distanceTo(controls.target);
    if (apart < 1e-5 * this.extent) return;
    this.flight = this.namedView = undefined;
    this.camera.position.copy(camera.position);
    this.controls.target.copy(controls.target);
    this.onChange();
  }

  /** The current camera pose [m]. */
  get pose(): CameraPose {
    const plain = ({ x, y, z }: THREE.Vector3) => ({ x, y, z });
    return { eye: plain(this.camera.position), target: plain(this.controls.target) };
  }

  /** Moves smoothly to a remote camera, whose poses arrive a few times per second. */
  moveTo(pose: CameraPose): void {
    this.flight = this.namedView = undefined;
    this.remotePose = pose;
    this.onChange();
  }

  private chase({ eye, target }: CameraPose): void {
    const part = this.reducedMotion() ? 1 : 1 - chaseRemainder;
    this.camera.position.lerp(eye, part);
    this.controls.target.lerp(target, part);
    if (this.camera.position.distanceTo(eye) < 1e-5 * this.extent) this.remotePose = undefined;
    this.onChange();
  }

  /** Advances transitions and damping to `now` [ms]. */
  update(now: number): void {
    if (this.remotePose !== undefined) this.chase(this.remotePose);
    if (this.flight !== undefined) this.fly(this.flight, now);
    this.controls.update();
  }

  private fly({ from, to, start }: { from: Outlook; to: Outlook; start: number }, now: number): void {
    const part = THREE.MathUtils.smootherstep((now - start) / flightDuration, 0, 1);
    this.show(flightAt(from, to, part));
    if (part >= 1) this.flight = undefined;
    this.onChange();
  }

  /** Orbits by these angles [rad] and zooms by a factor, for the keyboard. */
  nudge(azimuth: number, polar: number, zoom: number): void {
    this.flight = this.namedView = undefined;
    const { target } = this.controls;
    const away = this.camera.position.clone().sub(target);
    const radius = away.length() / zoom;
    const phi = Math.acos(THREE.MathUtils.clamp(away.z / away.length(), -1, 1)) + polar;
    const theta = Math.atan2(away.y, away.x) + azimuth;
    const level = THREE.MathUtils.clamp(phi, 0.01, Math.PI - 0.01);
    const ring = Math.sin(level);
    away.set(ring * Math.cos(theta), ring * Math.sin(theta), Math.cos(level)).multiplyScalar(radius);
    this.camera.position.copy(target).add(away);
    this.onChange();
  }

  /** Returns the orientation and scale of the view. */
  orientation(): ViewOrientation {
    this.camera.updateMatrixWorld(); // also before the next drawing
    const axis = (i: number) => new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, i);
    const [right, up, back] = [axis(0), axis(1), axis(2)];
    const { distance } = this.depth;
    const slope = Math.tan(THREE.MathUtils.degToRad(this.camera.fov / 2));
    return {
      right: directionLetter(right),
      left: directionLetter(right.clone().negate()),
      top: directionLetter(up),
      bottom: directionLetter(up.clone().negate()),
      pixelsPerMetre: this.canvas.clientHeight / (2 * slope * distance),
      axes: [right, up, back],
    };
  }
}
