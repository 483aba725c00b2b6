import * as THREE from "three";
import { lumenInCut, quadIndices, wallsInCut } from "../geometry/cut_walls";
import { axesOf, type AxisPlane, type SectionPicture } from "../geometry/section";
import type { BodyView } from "./body_view";
import { tissueOf } from "./tissues";

/** The anatomical planes, or no clipping. */
export const cutKinds = ["none", "sagittal", "coronal", "transverse"] as const;
export type CutKind = (typeof cutKinds)[number];

/** A cut through the scene by an anatomical plane. */
export interface Cut {
  kind: CutKind;
  /** Position of the plane, 0 to 1 across the scene. */
  fraction: number;
  /** Selects the side that is clipped. */
  flipped: boolean;
}

const normals: Record<Exclude<CutKind, "none">, THREE.Vector3> = {
  sagittal: new THREE.Vector3(1, 0, 0),
  coronal: new THREE.Vector3(0, 1, 0),
  transverse: new THREE.Vector3(0, 0, -1),
};

/** Returns the clipping plane through a scene within `box`; its negative side is clipped. */
export function clippingPlane({ kind, fraction, flipped }: Cut, box: THREE.Box3): THREE.Plane | undefined {
  if (kind === "none") return undefined;
  const normal = normals[kind].clone();
  const at = new THREE.Vector3().lerpVectors(box.min, box.max, fraction);
  if (flipped) normal.negate();
  return new THREE.Plane().setFromNormalAndCoplanarPoint(normal, at);
}

/** Returns the coordinate of the plane along its axis [m]. */
export function planeCoordinate({ kind, fraction }: Cut, box: THREE.Box3): number {
  const axis = ({ sagittal: "x", coronal: "y", transverse: "z", none: "x" } as const)[kind];
  return THREE.MathUtils.lerp(box.min[axis], box.max[axis], fraction);
}

/** How far the pictures of a cut lie inside the part that is kept, so that the cut does not clip them [m]. */
const cutInset = 3e-4;

/** Returns the plane of a cut; undefined without one. */
export function axisPlaneOf(cut: Cut, box: THREE.Box3): AxisPlane | undefined {
  if (cut.kind === "none") return undefined;
  const axis = ({ sagittal: 0, coronal: 1, transverse: 2 } as const)[cut.kind];
  return { axis, at: planeCoordinate(cut, box) };
}

/** Pictures in the plane of a cut, in exactly their colours. */
export class CutPictures {
  readonly object = new THREE.Group();
  private shown: SectionPicture[] = [];

  /** Shows pictures in the plane, whose positive side is kept. */
  show(pictures: SectionPicture[], plane: THREE.Plane | undefined): void {
    this.clear();
    if (plane === undefined) return;
    this.shown = pictures;
    for (const picture of pictures) this.object.add(pictureMesh(picture, plane.normal));
  }

  /** Returns where a ray first meets a picture [m]; undefined if it meets none. */
  hit(ray: THREE.Ray): THREE.Vector3 | undefined {
    for (const { axis, at, low, step, width, height, rgba } of this.shown) {
      const along = ray.direction.getComponent(axis);
      const distance = (at - ray.origin.getComponent(axis)) / along;
      if (along === 0 || distance <= 0) continue;
      const place = ray.at(distance, new THREE.Vector3());
      const [i, j] = axesOf(axis).map((each, k) => Math.floor((place.getComponent(each) - low[k]) / step));
      if (i < 0 || j < 0 || i >= width || j >= height || rgba[4 * (i + width * j) + 3] < 128) continue;
      return place;
    }
    return undefined;
  }

  private clear(): void {
    for (const child of this.object.children) {
      if (!(child instanceof THREE.Mesh)) continue;
      child.material.map.dispose();
      child.material.dispose();
      child.geometry.dispose();
    }
    this.object.clear();
    this.shown = [];
  }
}

function pictureMesh(picture: SectionPicture, kept: THREE.Vector3): THREE.Mesh {
  const { axis, at, low, step, width, height, rgba } = picture;
  const [a, b] = axesOf(axis);
  const corners = [0, 1, 2, 3].flatMap((corner) => {
    const place = [0, 0, 0];
    place[axis] = at + cutInset * Math.sign(kept.getComponent(axis));
    place[a] = low[0] + (corner & 1) * width * step;
    place[b] = low[1] + (corner >> 1) * height * step;
    return place;
  });
  const geometry = new THREE.BufferGeometry()
    .setAttribute("position", new THREE.Float32BufferAttribute(corners, 3))
    .setAttribute("uv", new THREE.Float32BufferAttribute([0, 0, 1, 0, 0, 1, 1, 1], 2))
    .setIndex([0, 1, 2, 2, 1, 3]);
  const map = new THREE.DataTexture(rgba, width, height);
  map.colorSpace = THREE.SRGBColorSpace;
  map.magFilter = map.minFilter = THREE.LinearFilter;
  map.needsUpdate = true;
  const material = new THREE.MeshBasicMaterial({
    map,
    alphaTest: 0.5,
    toneMapped: false,
    fog: false,
    side: THREE.DoubleSide,
  });
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}

/** Height of the strips that fill a lumen [m]; less than any wall. */
const strip = 8e-4;

/** The walls and the lumen of hollow organs where a plane cuts them. */
export class CutWalls {
  readonly object = new THREE.Mesh(
    new THREE.BufferGeometry(),
    new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.DoubleSide }),
  );

  constructor() {
    this.object.frustumCulled = false;
    this.object.visible = false;
  }

  /** Shows walls and lumina of bodies in the plane, whose side of `kept` is drawn; none without a plane. */
  show(views: readonly BodyView[], plane: AxisPlane | undefined, kept: THREE.Vector3 | undefined): void {
    const corners: number[] = [];
    const colors: number[] = [];
    const add = (quads: number[], color: string) => {
      const { r, g, b } = new THREE.Color(color);
      for (let i = 0; i < quads.length; i += 3) {
        corners.push(quads[i], quads[i + 1], quads[i + 2]);
        colors.push(r, g, b);
      }
    };
    for (const { body, group, isFaded, positions } of plane === undefined ? [] : views) {
      const { wall, section = body.color } = tissueOf(body);
      if (wall === undefined || !group.visible || isFaded) continue;
      const shift = cutInset * Math.sign(kept!.getComponent(plane!.axis));
      add(lumenInCut(positions.array, body.triangles, plane!, strip, 2 * shift), section);
      add(wallsInCut(positions.array, body.triangles, plane!, wall, shift), body.color);
    }
    this.object.visible = corners.length > 0;
    if (!this.object.visible) return;
    const index = Array.from({ length: corners.length / 2 }, (_, i) => 4 * Math.floor(i / 6) + quadIndices[i % 6]);
    this.object.geometry.dispose();
    this.object.geometry = new THREE.BufferGeometry()
      .setAttribute("position", new THREE.Float32BufferAttribute(corners, 3))
      .setAttribute("color", new THREE.Float32BufferAttribute(colors, 3))
      .setIndex(index);
  }
}
