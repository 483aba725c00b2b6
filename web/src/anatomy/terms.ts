import terminology from "./terminology.json";
import { t } from "../language/translate";

/** The name of a structure and its definition in a sentence. */
export interface Term {
  /** Name of the body in the scene. */
  body: string;
  /** Part of the body; empty for the whole body. */
  region: string;
  name: string;
  /** Name of the Terminologia Anatomica (second edition, 2019); empty if it has no name for the structure. */
  latin: string;
  /** Other words to find it by. */
  also: string;
  definition: string;
}

/** One entry of terminology.json: the terms of all bodies whose name matches. */
interface Entry {
  /** Regular expression for the name of the body; its groups `number` and `side` fill the other texts. */
  body: string;
  /** Part of the body; whole if not set. */
  region?: string;
  /** First and last number of the structures with this entry, and whether there are two sides. */
  numbers?: number[];
  sides?: boolean;
  name: string;
  latin: string;
  also?: string;
  /** By number ("3"), range of numbers ("3-6"), or "" for all. */
  definitions: Record<string, string | undefined>;
}

/** The terminology, whose texts are those of the catalogues. */
const entries: Entry[] = terminology.structures;
const matchers = entries.map(({ body }) => new RegExp(body));

/** Returns the terms of a body: the whole and its regions; empty for an unknown body. */
export function termsOf(body: string): Term[] {
  return entries.flatMap((entry, i) => {
    const match = matchers[i].exec(body);
    return match === null ? [] : [termOf(entry, body, match.groups ?? {})];
  });
}

/** Number of structures that the terminology defines. */
export function countOfTerms(): number {
  const sum = (total: number, { numbers = [1, 1], sides }: Entry) =>
    total + (numbers[1] - numbers[0] + 1) * (sides === true ? 2 : 1);
  return entries.reduce(sum, 0);
}

function termOf(entry: Entry, body: string, { number, side }: Record<string, string | undefined>): Term {
  const fill = (text: string) =>
    text.replace(/\{(\w+)\}/g, (_, word: string) => wordOf(word, Number(number), side ?? ""));
  return {
    body,
    region: entry.region ?? "",
    name: fill(t(entry.name)),
    latin: fill(entry.latin),
    also: fill(entry.also ?? ""),
    definition: t(definitionOf(entry.definitions, Number(number))),
  };
}

function definitionOf(definitions: Entry["definitions"], number: number): string {
  const key = Object.keys(definitions).find((range) => {
    const [first, last = first] = range.split("-").map(Number);
    return range === "" || (first <= number && number <= last);
  });
  return (key !== undefined && definitions[key]) || "";
}

const latinSides = {
  right: { femina: "dextra", masculine: "dexter", genitive: "dextri" },
  left: { femina: "sinistra", masculine: "sinister", genitive: "sinistri" },
};

/** Returns what stands for a word in braces. Throws RangeError for an unknown word. */
function wordOf(word: string, number: number, side: string): string {
  const latin = side === "right" || side === "left" ? latinSides[side] : { femina: "", masculine: "", genitive: "" };
  const words: Record<string, string | undefined> = {
    ...latin,
    side: t(side),
    Side: upper(side),
    number: String(number),
    ordinal: `${number}${["th", "st", "nd", "rd"][number < 4 ? number : 0]}`,
    Ordinal: upper(ordinals[number] ?? ""),
    roman: romans[number],
  };
  const text = words[word];
  if (text === undefined) throw new RangeError(`terminology.json: {${word}} is unknown, or has no number ${number}.`);
  return text;
}

const upper = (text: string) => text.charAt(0).toUpperCase() + text.slice(1);
const romans = ["", "I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX", "X", "XI", "XII"];
const ordinals = "|first|second|third|fourth|fifth|sixth|seventh|eighth|ninth|tenth|eleventh|twelfth".split("|");
