import { readFileSync } from "node:fs";
import { join } from "node:path";
import { describe, expect, test } from "vitest";
import { findBreaches, findCycle, foldersOf, importsOf, readRules, readSources } from "./imports";

const web = join(import.meta.dirname, "../../../web");
const files = importsOf(readSources(join(web, "src")));
const folders = foldersOf(files);

describe("the sources of the viewer", () => {
  test("AreFound", () => {
    expect(files.size).toBeGreaterThan(100);
    expect(folders.get("viewer")).toContain("geometry");
  });

  test("HaveNoCycleOfFiles", () => expect(findCycle(files)).toBeUndefined());

  test("HaveNoCycleOfFolders", () => expect(findCycle(folders)).toBeUndefined());

  test("ImportWhatTheTableInTheReadmeAllows", () => {
    expect(findBreaches(folders, readRules(readFileSync(join(web, "README.md"), "utf8")))).toEqual([]);
  });

  test("HaveAtMostThirtyFilesInAFolder", () => {
    const counts = new Map<string, number>();
    for (const path of files.keys()) {
      const folder = path.split("/").slice(0, -1).join("/");
      counts.set(folder, (counts.get(folder) ?? 0) + 1);
    }
    expect([...counts].filter(([, count]) => count > 30)).toEqual([]);
  });
});

describe("a tree that breaks the rules", () => {
  const bad = importsOf(
    new Map([
      ["main", 'import { a } from "./a/one";'],
      ["a/one", 'import type { Two } from "./two";\nimport "./style.css";\nimport * as THREE from "three";'],
      ["a/two", 'export { three } from "../b/three";'],
      ["b/three", 'const lazy = () => import("../a/one");\nimport { Frame } from "../gen/v1/frames_pb";'],
    ]),
  );

  test("HasItsImportsOfEveryKindFound", () => {
    expect([...bad.get("a/one")!]).toEqual(["a/two", "a/style.css"]);
    expect([...bad.get("a/two")!]).toEqual(["b/three"]);
    expect([...bad.get("b/three")!]).toEqual(["a/one", "gen/v1/frames_pb"]);
  });

  test("HasItsCyclesFound", () => {
    expect(findCycle(bad)).toEqual(["a/one", "a/two", "b/three", "a/one"]);
    expect(findCycle(foldersOf(bad))).toEqual(["a", "b", "a"]);
    expect(findCycle(new Map([["a", new Set(["b", "c"])], ["b", new Set(["c"])]]))).toBeUndefined(); // prettier-ignore
  });

  test("HasItsBreachesNamed", () => {
    const rules = readRules(
      "text\n\n| folder | what | may import |\n| -- | -- | -- |\n| `.` | | `a` |\n| `a` | | `c` |\n| `c` | | |\n",
    );
    expect(findBreaches(foldersOf(bad), rules)).toEqual([
      "a imports b",
      "a does not import c",
      "b has no row",
      "there is no folder c",
    ]);
  });

  test("WithoutATableIsAnError", () => expect(() => readRules("no table")).toThrow("There is no table"));
});
