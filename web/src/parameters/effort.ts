import type { Parameters } from "../gen/phrenic/v1/parameters_pb";
import type { Values } from "../state/undo_history";

/** Activations of the deepest breath, preset "deep" of the scene `thorax`. */
export const fullActivations = { diaphragm: 0.45, intercostal: 1.76 };

/** Breathing effort, as the student view shows it. */
export interface Effort {
  /** Mean share of the deepest breath's activations, diaphragm and intercostal muscles, from 0. */
  depth: number;
  /** Breaths per minute. */
  rate: number;
  /** Share of the diaphragm in the effort, 0 to 1; undefined if no muscle is active. */
  belly: number | undefined;
}

/** Returns the time of one breath [s]; 4 for a scene that has none. */
export function breathLengthOf(of: Pick<Parameters, "breathLength"> | undefined): number {
  return of?.breathLength ?? 4;
}

/**
 * Returns the effort of live parameters: with u = activation / full activation, depth (uD + uI) / 2, belly uD / (uD +
 * uI).
 */
export function effortOf(
  of: Pick<Parameters, "diaphragmActivation" | "intercostalActivation" | "breathLength">,
): Effort {
  const diaphragm = (of.diaphragmActivation ?? 0) / fullActivations.diaphragm;
  const sum = diaphragm + (of.intercostalActivation ?? 0) / fullActivations.intercostal;
  return { depth: sum / 2, rate: 60 / breathLengthOf(of), belly: sum > 0 ? diaphragm / sum : undefined };
}

/** Returns the activations of a depth and a share of the diaphragm: the inverse of `effortOf`. */
export function activationsOf(depth: number, belly: number): Values {
  const rounded = (value: number) => Number(value.toPrecision(4));
  return {
    diaphragmActivation: rounded(2 * depth * belly * fullActivations.diaphragm),
    intercostalActivation: rounded(2 * depth * (1 - belly) * fullActivations.intercostal),
  };
}
