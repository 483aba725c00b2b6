import * as THREE from "three";
import type { VertexRef } from "../geometry/vertices";
import type { BodyView } from "./body_view";
import type { CutPictures } from "./clipping";
import { pickVertex, pointerOf } from "./picking";

/** A pointer that moves farther [CSS pixels] or stays down longer [ms] than this turns the view. */
const maxMovement = 5;
const maxDuration = 500;

/**
 * Calls `picked` with the vertex under each click; undefined if it meets no body. Of a picture of a cut in front of all
 * surfaces `inside` gets the place instead [m]. Returns a function that picks at a place on the canvas [CSS pixels] as
 * a click does, for the keyboard.
 */
export function enablePicking(
  canvas: HTMLCanvasElement,
  camera: THREE.Camera,
  views: () => BodyView[],
  cut: () => THREE.Plane | undefined,
  picked: (vertex: VertexRef | undefined) => void,
  pictures: CutPictures,
  inside: (place: [number, number, number]) => void,
): (x: number, y: number) => void {
  const pickAt = (offsetX: number, offsetY: number) => {
    const visible = views().filter(({ group, isFaded }) => group.visible && !isFaded);
    const bodies = visible.map((view) => ({ positions: view.worldPositions(), triangles: view.body.triangles }));
    const pointer = pointerOf({ offsetX, offsetY }, canvas);
    const found = pickVertex(pointer, camera, bodies, cut());
    const caster = new THREE.Raycaster();
    caster.setFromCamera(pointer, camera);
    const place = pictures.hit(caster.ray);
    const { origin } = caster.ray;
    const nearer = found === undefined || (place?.distanceTo(origin) ?? Infinity) < found.position.distanceTo(origin);
    if (place !== undefined && nearer) return inside([place.x, place.y, place.z]);
    picked(found && { body: visible[found.body].body.name, vertex: found.vertex });
  };
  let down: PointerEvent | undefined;
  canvas.addEventListener("pointerdown", (event) => {
    down = event.button === 0 && !event.shiftKey ? event : undefined;
  });
  canvas.addEventListener("pointerup", (event) => {
    if (down === undefined || event.timeStamp - down.timeStamp > maxDuration) return;
    if (Math.hypot(event.offsetX - down.offsetX, event.offsetY - down.offsetY) > maxMovement) return;
    pickAt(event.offsetX, event.offsetY);
  });
  return pickAt;
}
