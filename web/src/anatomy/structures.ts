import type { Body } from "../geometry/bodies";
import type { VertexRef } from "../geometry/vertices";
import { diaphragmRegions } from "./regions";
import { type Term, termsOf } from "./terms";

/** A structure of the scene that has a name. */
export interface Structure extends Term {
  /** Indices of the structure's vertices; undefined for all of the body. */
  vertices: number[] | undefined;
  /** Share of its vertices that were filled from the generated thorax; undefined for none. */
  filled?: number | undefined;
}

/** The named structures of a scene. */
export class Structures {
  readonly all: Structure[];
  private readonly regions = new Map<string, string[]>();

  constructor(bodies: Body[]) {
    this.all = bodies.flatMap((body) =>
      this.structuresOf(body, bodies).map((each) => ({ ...each, ...filledShare(body, each.vertices) })),
    );
  }

  /** Returns the structure at a vertex: a region if the body has regions; undefined if it has no name. */
  at({ body, vertex }: VertexRef): Structure | undefined {
    const region = this.regions.get(body)?.[vertex] ?? "";
    const own = this.all.filter((each) => each.body === body);
    return own.find((each) => each.region === region) ?? own.find((each) => each.region === "");
  }

  /** Returns the structures that have all words of `text` in their names, the best first; empty for no words. */
  search(text: string, most = 8): Structure[] {
    const words = plain(text)
      .split(" ")
      .filter((word) => word !== "");
    if (words.length === 0) return [];
    const found = this.all.flatMap((structure) => {
      const score = scoreOf(structure, words);
      return score === undefined ? [] : [{ structure, score }];
    });
    return found
      .sort((a, b) => b.score - a.score)
      .slice(0, most)
      .map(({ structure }) => structure);
  }

  private structuresOf(body: Body, bodies: Body[]): Structure[] {
    const terms = termsOf(body.name);
    if (!terms.some(({ region }) => region !== "")) return terms.map((term) => ({ ...term, vertices: undefined }));
    const regions = diaphragmRegions(body, bodies);
    this.regions.set(body.name, regions);
    return terms.flatMap((term): Structure[] => {
      if (term.region === "") return [{ ...term, vertices: undefined }];
      const vertices = regions.flatMap((region, i) => (region === term.region ? [i] : []));
      return vertices.length === 0 ? [] : [{ ...term, vertices }];
    });
  }
}

function filledShare({ template, rest }: Body, vertices: number[] | undefined): { filled?: number } {
  if (!template?.length) return {};
  if (vertices === undefined) return { filled: template.length / (rest.length / 3) };
  const filled = new Set(template);
  return { filled: vertices.filter((vertex) => filled.has(vertex)).length / vertices.length };
}

/** Returns how well a structure fits: whole words count more than parts; undefined if a word is missing. */
function scoreOf({ name, latin, also, region }: Structure, words: string[]): number | undefined {
  const known = plain(`${name} ${latin} ${also}`).split(" ");
  let score = region === "" ? 0.5 : 0;
  for (const word of words) {
    const [exact, start] = [known.includes(word), known.some((each) => each.startsWith(word))];
    if (!start) return undefined;
    score += exact ? 2 : 1;
  }
  return score + (plain(name).startsWith(words[0]) ? 1 : 0) - known.length / 100;
}

function plain(text: string): string {
  return text
    .toLowerCase()
    .replace(/[^\p{L}\p{N}]+/gu, " ")
    .trim();
}
