import { afterColon, fixed, t } from "../language/translate";
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
  if (other !== undefined && domes !== "") words.push(`${capitalised(other.label)}: ${afterColon(domes)}`);
  return words.filter((each) => each !== "").join(" ");
}

function airWords({ tidalVolume }: BreathMotion, other: BreathMotion | undefined): string {
  const litres = (cubicMetres: number) => fixed(1000 * cubicMetres, 2);
  if (1000 * tidalVolume < leastLitres) return t("No air moves.");
  if (other === undefined) return t("A breath brings {0} l of air.", litres(tidalVolume));
  return t("A breath brings {0} l of air instead of {1}.", litres(tidalVolume), litres(other.tidalVolume));
}

function domeWords({ tidalVolume, domes }: BreathMotion): string {
  if (1000 * tidalVolume < leastLitres || domes.length === 0) return "";
  const moves = domes.map(moveOf);
  if (moves.length !== 2) return moves.map((move) => t("The {0} {1}.", t(move.name), phrase(move))).join(" ");
  const [first, second] = moves;
  const paradoxical = moves.some(({ way }) => way === "rises") ? t(": paradoxical motion") : "";
  if (first.way !== second.way) {
    const words = "The {0} {1} while the {2} {3}{4}.";
    return t(words, t(first.name), phrase(first), side(second), phrase(second), paradoxical);
  }
  if (first.way === "hardly moves") return t("Both domes hardly move.");
  const rise = "Both domes rise, the {0} by {1} mm and the {2} by {3}{4}.";
  const fall = "Both domes fall, the {0} by {1} mm and the {2} by {3}{4}.";
  const [words, numbers] = [first.way === "rises" ? rise : fall, [first.millimetres, second.millimetres]];
  return t(words, side(first), numbers[0], side(second), numbers[1], paradoxical);
}

function moveOf({ name, change }: BreathMotion["domes"][number]): Move {
  const millimetres = Math.round(1000 * Math.abs(change));
  const way = millimetres < leastMillimetres ? "hardly moves" : change > 0 ? "rises" : "falls";
  return { name, way, millimetres };
}

function phrase({ way, millimetres }: Move): string {
  if (way === "hardly moves") return t("hardly moves");
  return t(way === "rises" ? "rises by {0} mm" : "falls by {0} mm", millimetres);
}

/** Returns the name of a dome without the noun: "right". */
const side = ({ name }: Move) => t(name).replace(t("dome"), "").trim();

function capitalised(words: string): string {
  return words.charAt(0).toUpperCase() + words.slice(1);
}
