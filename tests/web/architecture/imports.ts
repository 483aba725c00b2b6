import { readdirSync, readFileSync } from "node:fs";
import { dirname, join, posix } from "node:path";
import ts from "typescript";

/** The text of source files by their path below the source folder, with "/" and without ".ts". */
export type Sources = ReadonlyMap<string, string>;

/** What each node imports: files, or folders. */
export type Graph = ReadonlyMap<string, ReadonlySet<string>>;

/** Folders whose content is generated: their files count as one file, and their own imports are not read. */
const generated = "gen";

/** Reads every TypeScript file below `folder` except generated ones. */
export function readSources(folder: string): Sources {
  const sources = new Map<string, string>();
  for (const name of readdirSync(folder, { recursive: true, encoding: "utf8" })) {
    const path = name.replaceAll("\\", "/");
    if (!path.endsWith(".ts") || path.startsWith(`${generated}/`)) continue;
    sources.set(path.slice(0, -".ts".length), readFileSync(join(folder, name), "utf8"));
  }
  return sources;
}

/**
 * Returns the files that each file imports by a relative path: values and types, static and dynamic, and re-exports.
 */
export function importsOf(sources: Sources): Graph {
  return new Map(
    [...sources].map(([path, text]) => {
      const names = ts.preProcessFile(text, true, true).importedFiles.map(({ fileName }) => fileName);
      const relative = names.filter((name) => name.startsWith("."));
      return [path, new Set(relative.map((name) => posix.join(dirname(path), name)))];
    }),
  );
}

/** Returns the folder of a file; "." for files of the source folder itself. */
export function folderOf(path: string): string {
  return path.startsWith(`${generated}/`) ? generated : dirname(path);
}

/** Returns the folders that each folder imports, without itself. */
export function foldersOf(files: Graph): Graph {
  const folders = new Map<string, Set<string>>();
  for (const [path, targets] of files) {
    const from = folderOf(path);
    const known = folders.get(from) ?? new Set<string>();
    folders.set(from, known);
    for (const target of targets) if (folderOf(target) !== from) known.add(folderOf(target));
  }
  return folders;
}

/** Returns the nodes of one cycle in their order, the first repeated at the end; undefined if there is no cycle. */
export function findCycle(graph: Graph): string[] | undefined {
  const finished = new Set<string>();
  const visit = (node: string, path: string[]): string[] | undefined => {
    if (path.includes(node)) return [...path.slice(path.indexOf(node)), node];
    if (finished.has(node)) return undefined;
    for (const next of graph.get(node) ?? []) {
      const cycle = visit(next, [...path, node]);
      if (cycle !== undefined) return cycle;
    }
    finished.add(node);
    return undefined;
  };
  for (const node of graph.keys()) {
    const cycle = visit(node, []);
    if (cycle !== undefined) return cycle;
  }
  return undefined;
}

/**
 * Reads the rules from the Markdown table with the columns "folder | what | may import": folder names stand in
 * backquotes, the source folder itself is ".". Throws Error if there is no such table.
 */
export function readRules(markdown: string): Graph {
  const lines = markdown.split("\n").map((line) => line.split("|").map((cell) => cell.trim()));
  const head = lines.findIndex((cells) => cells[1] === "folder" && cells[3] === "may import");
  if (head < 0) throw new Error('There is no table "folder | what | may import".');
  const end = lines.findIndex((cells, i) => i > head && cells.length < 5);
  const names = (cell: string) => new Set([...cell.matchAll(/`([^`]+)`/g)].map(([, name]) => name));
  const rows = lines.slice(head + 2, end < 0 ? undefined : end);
  return new Map(rows.map(([, folder, , allowed]) => [[...names(folder)][0], names(allowed)]));
}

/** Compares folders with the rules: returns each import and each folder that the rules lack, and rules without use. */
export function findBreaches(folders: Graph, rules: Graph): string[] {
  const breaches: string[] = [];
  for (const [from, targets] of folders) {
    const allowed = rules.get(from);
    if (allowed === undefined) breaches.push(`${from} has no row`);
    for (const to of targets) if (allowed?.has(to) === false) breaches.push(`${from} imports ${to}`);
    for (const to of allowed ?? []) if (!targets.has(to)) breaches.push(`${from} does not import ${to}`);
  }
  for (const from of rules.keys()) if (!folders.has(from)) breaches.push(`there is no folder ${from}`);
  return breaches;
}
