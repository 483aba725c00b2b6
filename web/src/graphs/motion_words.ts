import type { BreathMotion } from "./breath_motion";

/** Smaller changes of a dome [mm] and smaller breaths [l] are reported as no motion. */
const leastMillimetres = 1;
const leastLitres = 0.02;

interface Move {
  name: string;
  way: "rises" | "falls" | "hardly moves";
  millimetres: number;
}

/** A breath to compare with, and what it is called: "Quiet, supine". */
export interface NamedMotion {
  label: string;
  motion: BreathMotion;
}

/**
 * Returns what a breath does in words: "The right dome rises by 7 mm while the left falls by 16 mm: paradoxical motion.
 * A breath brings 0.39 l of air." With another breath: "... 0.39 l of air instead of 0.50. Quiet, supine: both domes
 * fall, the right by 13 mm and the left by 7."
 */
export function motionWords(motion: BreathMotion, other?: NamedMotion): string {
  const words = [domeWords(motion), airWords(motion, other?.motion)];
  const domes = other === undefined ? "" : domeWords(other.motion);
  if (other !== undefined && domes !== "") words.push(`${capitalised(other.label)}: ${uncapitalised(domes)}`);
  return words.filter((each) => each !== "").join(" ");
}

function airWords({ tidalVolume }: BreathMotion, other: BreathMotion | undefined): string {
  const litres = (cubicMetres: number) => (1000 * cubicMetres).toFixed(2);
  if (1000 * tidalVolume < leastLitres) return "No air moves.";
  const instead = other === undefined ? "" : ` instead of ${litres(other.tidalVolume)}`;
  return `A breath brings ${litres(tidalVolume)} l of air${instead}.`;
}

function domeWords({ tidalVolume, domes }: BreathMotion): string {
  if (1000 * tidalVolume < leastLitres || domes.length === 0) return "";
  const moves = domes.map(moveOf);
  if (moves.length !== 2) return moves.map((move) => `The ${move.name} ${phrase(move)}.`).join(" ");
  const [first, second] = moves;
  const paradoxical = moves.some(({ way }) => way === "rises") ? ": paradoxical motion" : "";
  if (first.way !== second.way)
    return `The ${first.name} ${phrase(first)} while the ${side(second)} ${phrase(second)}${paradoxical}.`;
  if (first.way === "hardly moves") return "Both domes hardly move.";
  const verb = first.way === "rises" ? "rise" : "fall";
  return `Both domes ${verb}, the ${side(first)} by ${first.millimetres} mm and the ${side(second)} by ${second.millimetres}${paradoxical}.`;
}

function moveOf({ name, change }: BreathMotion["domes"][number]): Move {
  const millimetres = Math.round(1000 * Math.abs(change));
  const way = millimetres < leastMillimetres ? "hardly moves" : change > 0 ? "rises" : "falls";
  return { name, way, millimetres };
}

function phrase({ way, millimetres }: Move): string {
  return way === "hardly moves" ? way : `${way} by ${millimetres} mm`;
}

const side = ({ name }: Move) => name.replace(/ dome$/, "");

function capitalised(words: string): string {
  return words.charAt(0).toUpperCase() + words.slice(1);
}

function uncapitalised(words: string): string {
  return words.charAt(0).toLowerCase() + words.slice(1);
}
