import type * as THREE from "three";
import type { Body } from "../geometry/bodies";
import type { Cut } from "./clipping";
import type { ViewName } from "./named_views";

/** A view with a name in plain words: a direction, and for some a cut through the scene. */
export interface Viewpoint {
  name: string;
  label: string;
  /** The key that shows it. */
  key: string;
  view: ViewName;
  /** Not set: the whole scene. */
  cut?: Cut;
}

const directions: [view: ViewName, label: string, key: string][] = [
  ["front", "Front", "1"],
  ["back", "Back", "2"],
  ["left", "Left", "3"],
  ["right", "Right", "4"],
  ["top", "Above", "5"],
  ["bottom", "Below", "6"],
  ["abdomen", "From the abdomen up", "7"],
];

const cuts = [
  ["coronal", "Coronal cut through the domes", "8"],
  ["sagittal", "Sagittal cut through the right dome", "9"],
  ["transverse", "Transverse cut at T10", "0"],
] as const;
const [coronalCut, sagittalCut, transverseCut] = cuts.map(([name, label, key]) => ({ name, label, key }));

/** The key and the label of each viewpoint that a scene may have. */
export const viewpointKeys: [key: string, label: string][] = [...directions, ...cuts].map(([, label, key]) => [
  key,
  label,
]);

/** Returns the viewpoints that the bodies of a scene allow; cuts are within `box`, the scene at rest [m]. */
export function viewpoints(bodies: Body[], box: THREE.Box3): Viewpoint[] {
  const views: Viewpoint[] = directions.map(([view, label, key]) => ({ name: view, label, key, view }));
  const diaphragm = bodies.find(({ name }) => name === "diaphragm");
  if (diaphragm !== undefined) views.push(...cutsThroughDomes(diaphragm, box));
  const vertebra = bodies.find(({ name }) => name === "t10");
  if (vertebra !== undefined) views.push(cutAtVertebra(vertebra, box));
  return views;
}

/** The sagittal cut keeps the right side, which the left side hides. */
function cutsThroughDomes({ rest }: Body, box: THREE.Box3): Viewpoint[] {
  const [right, left] = [domeOf(rest, -1), domeOf(rest, 1)];
  const coronal = fractionOf((rest[right + 1] + rest[left + 1]) / 2, box.min.y, box.max.y);
  const sagittal = fractionOf(rest[right], box.min.x, box.max.x);
  return [
    { ...coronalCut, view: "front", cut: { kind: "coronal", fraction: coronal, flipped: false } },
    { ...sagittalCut, view: "left", cut: { kind: "sagittal", fraction: sagittal, flipped: true } },
  ];
}

/** Seen from below, as tomograms are shown. */
function cutAtVertebra({ rest }: Body, box: THREE.Box3): Viewpoint {
  let [low, high] = [Infinity, -Infinity];
  for (let i = 2; i < rest.length; i += 3) [low, high] = [Math.min(low, rest[i]), Math.max(high, rest[i])];
  const fraction = fractionOf((low + high) / 2, box.min.z, box.max.z);
  const cut: Cut = { kind: "transverse", fraction, flipped: true };
  return { ...transverseCut, view: "bottom", cut };
}

/** Returns the index of the x coordinate of the highest vertex on one side, -1 for the right. */
function domeOf(rest: Float32Array, side: number): number {
  let top = 0;
  let height = -Infinity;
  for (let i = 0; i < rest.length; i += 3) if (side * rest[i] > 0 && rest[i + 2] > height) height = rest[(top = i) + 2];
  return top;
}

function fractionOf(value: number, low: number, high: number): number {
  return Math.min(1, Math.max(0, (value - low) / (high - low || 1)));
}
