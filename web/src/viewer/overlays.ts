import * as THREE from "three";
import type { ActionLine, Body } from "../geometry/bodies";
import { lineMaterial, pointMaterial } from "./materials";
import { ThickLines } from "./thick_lines";

/** The kinds of overlay. */
export const overlayKinds = ["wireframe", "links", "lines", "attachments"] as const;
/** A kind of overlay. */
export type OverlayKind = (typeof overlayKinds)[number];

/** What an overlay uses of its body. */
export interface OverlayHost {
  readonly body: Body;
  readonly group: THREE.Group;
  /** x y z per vertex [m], updated with every frame. */
  readonly positions: THREE.BufferAttribute;
  /** Pairs of vertex indices. */
  readonly edges: Uint32Array<ArrayBuffer>;
  /** Returns a geometry over the body's vertices; `index` selects some of them. */
  geometry(index?: Uint32Array<ArrayBuffer>): THREE.BufferGeometry;
  /** Adds lines that are updated with every frame. */
  addThickLines(lines: ThickLines): void;
}

/** An overlay that can be switched; created when it is shown first. */
export interface Overlay {
  kind: OverlayKind;
  show(on: boolean): void;
}

const linkColor = "#5ec8ff";
const lineColor = "#ffd166";
const attachedColor = "#7be495";
const fixedColor = "#b99bff";
/** More lines than this are drawn one pixel wide. */
const maxThickLines = 3000;

/** Returns the overlays that the data of a body allows. */
export function addOverlays(view: OverlayHost): Overlay[] {
  const { body } = view;
  const overlays: Overlay[] = [];
  const add = (kind: OverlayKind, make: () => THREE.Object3D) => overlays.push(new Lazy(kind, view.group, make));
  if (body.triangles.length > 0)
    add("wireframe", () => segments(view, view.edges, lineMaterial("#ffffff", 0.2, false)));
  if (body.rigidLinks.length > 0) add("links", () => links(view));
  if (body.actionLines.length > 0) add("lines", () => arrows(body.actionLines));
  if (body.attached.length > 0) add("attachments", () => points(view, body.attached, attachedColor));
  if (body.fixed.length > 0) add("attachments", () => points(view, body.fixed, fixedColor));
  return overlays;
}

class Lazy implements Overlay {
  private object: THREE.Object3D | undefined;

  constructor(
    readonly kind: OverlayKind,
    private readonly parent: THREE.Object3D,
    private readonly make: () => THREE.Object3D,
  ) {}

  show(on: boolean): void {
    if (on && this.object === undefined) {
      this.object = this.make();
      this.parent.add(this.object);
    }
    if (this.object !== undefined) this.object.visible = on;
  }
}

function segments(view: OverlayHost, pairs: Uint32Array<ArrayBuffer>, material: THREE.Material): THREE.LineSegments {
  const lines = new THREE.LineSegments(view.geometry(pairs), material);
  lines.frustumCulled = false;
  return lines;
}

function links(view: OverlayHost): THREE.Object3D {
  const pairs = view.body.rigidLinks;
  if (pairs.length / 2 > maxThickLines) return segments(view, pairs, lineMaterial(linkColor, 0.75, true));
  const lines = new ThickLines(pairs, view.positions, linkColor, 2.5);
  Object.assign(lines.object.material, { depthTest: false, transparent: true, opacity: 0.8 });
  lines.object.renderOrder = 1;
  view.addThickLines(lines);
  return lines.object;
}

function points(view: OverlayHost, index: Uint32Array<ArrayBuffer>, color: string): THREE.Points {
  const result = new THREE.Points(view.geometry(index), pointMaterial(color, 5));
  result.frustumCulled = false;
  return result;
}

/** Arrows from the origin of each line in the direction of its force. */
function arrows(lines: ActionLine[]): THREE.Group {
  const group = new THREE.Group();
  const material = new THREE.MeshBasicMaterial({
    color: lineColor,
    depthTest: false,
    transparent: true,
    opacity: 0.9,
    toneMapped: false,
  });
  for (const line of lines) group.add(arrow(line, material));
  return group;
}

function arrow(line: ActionLine, material: THREE.Material): THREE.Group {
  const width = line.length / 60;
  const head = 8 * width;
  const shaft = new THREE.Mesh(new THREE.CylinderGeometry(width, width, line.length - head, 10), material);
  shaft.position.y = (line.length - head) / 2;
  const tip = new THREE.Mesh(new THREE.ConeGeometry(3 * width, head, 16), material);
  tip.position.y = line.length - head / 2;
  const result = new THREE.Group().add(shaft, tip);
  result.renderOrder = 2;
  result.position.fromArray(line.origin);
  result.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), new THREE.Vector3().fromArray(line.direction));
  return result;
}
