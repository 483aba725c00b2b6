import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { create, fromJsonString } from "@bufbuild/protobuf";
import { describe, expect, test } from "vitest";
import { sceneNames } from "../../../web/src/app/lesson_scene";
import { type Claim, ClaimSchema, LessonSchema } from "../../../web/src/gen/phrenic/v1/lesson_pb";
import { cmH2O } from "../../../web/src/graphs/units";
import { checkLesson, presetOf } from "../../../web/src/session/lessons";

const web = join(import.meta.dirname, "../../../web");
const folder = join(web, "public/lessons");
const names = JSON.parse(readFileSync(join(folder, "index.json"), "utf8")) as string[];
const sceneOf = (name: string) => readFileSync(join(web, `../server/scenes/${name}.textproto`), "utf8");
const read = (name: string) => fromJsonString(LessonSchema, readFileSync(join(folder, `${name}.json`), "utf8"));

const layersOf = (scene: string) => [...new Set([...scene.matchAll(/\blayer: "(.*?)"/g)].map(([, layer]) => layer))];

/** What the placeholders in the names of a scene's bodies may stand for. */
const placeholders: [string, string[]][] = [
  ["{side}", ["right", "left"]],
  ["{number}", Array.from({ length: 12 }, (_, i) => String(i + 1))],
  ["{vertebra}", [...Array.from({ length: 12 }, (_, i) => `t${i + 1}`), "l1", "l2", "l3"]],
];

/** Returns the names that the bodies of a scene have, or could have. */
function bodiesOf(scene: string): string[] {
  const written = [...scene.matchAll(/^bodies \{\s+name: "(.*?)"/gm)].map(([, name]) => name);
  return placeholders.reduce(
    (names, [word, values]) =>
      names.flatMap((name) => (name.includes(word) ? values.map((value) => name.replace(word, value)) : [name])),
    written,
  );
}

/** SI unit and value of each unit of a caption. */
const units: Record<string, [si: string, factor: number]> = {
  mm: ["m", 1e-3],
  l: ["m^3", 1e-3],
  "cmH₂O": ["Pa", cmH2O],
};

/** A number with its SI unit. */
interface Quantity {
  unit: string;
  value: number;
}

const quantity = (value: number, name: string): Quantity => ({ unit: units[name][0], value: value * units[name][1] });

/** Returns the numbers with a unit in a caption. */
function numbersIn(caption: string): Quantity[] {
  const found = caption.matchAll(/([−]?\d+(?:\.\d+)?) (mm|l|cmH₂O)(?![a-z])/g);
  return [...found].map(([, digits, unit]) => quantity(Number(digits.replace("−", "-")), unit));
}

/** Returns the SI unit of a measure of the scene, by what it reads. */
function unitOf(scene: string, measure: string): string {
  const line = scene.split("\n").find((each) => each.startsWith(`measures { name: "${measure}"`)) ?? "";
  if (line.includes("highest {")) return "m";
  const output = /output: "(.*?)"/.exec(line)?.[1] ?? "";
  if (output.includes("pressure")) return "Pa";
  return output.includes("volume") ? "m^3" : "1";
}

/** True if the limits of a claim of the same unit contain the number, whichever way it is counted. */
function isClaimed(scene: string, claims: Claim[], { unit, value }: Quantity): boolean {
  const within = (number: number) =>
    claims.some(
      ({ measure, minimum = NaN, maximum = NaN }) =>
        unitOf(scene, measure) === unit && number >= minimum && number <= maximum,
    );
  return within(value) || within(-value);
}

/** Measures whose course can be predicted. */
const predictable = ["lung volume", "right dome", "left dome", "pleural pressure"];

test("TheIndexNamesEveryLesson", () => {
  const files = readdirSync(folder).filter((file) => file !== "index.json");
  expect(names.map((name) => `${name}.json`).sort()).toEqual(files.sort());
});

test("ANumberOfACaptionIsRead", () => {
  expect(numbersIn("falls by 14 mm, brings 0.5 l at −3 cmH₂O, three times")).toEqual([
    { unit: "m", value: 0.014 },
    { unit: "m^3", value: 0.0005 },
    { unit: "Pa", value: -294.1995 },
  ]);
});

test("AClaimOfAnotherUnitIsNone", () => {
  const claims = [create(ClaimSchema, { measure: "lung volume", minimum: 0.0024, maximum: 0.0026 })];
  const scene = sceneOf("thorax");
  expect(isClaimed(scene, claims, quantity(2.5, "l"))).toBe(true);
  expect(isClaimed(scene, claims, quantity(2.5, "mm"))).toBe(false);
});

test("AMeasurementOfABodyThatTheSceneLacksIsNamedByField", () => {
  const points = [{ body: "rib-5-left", rest: { x: 0.1 } }];
  const measurements = [{ tool: "body", points }];
  const lesson = create(LessonSchema, { scene: "thorax", steps: [{ view: { measurements } }] });
  const check = (bodies: string[]) => () => checkLesson(lesson, sceneNames("thorax", [], [], bodies));
  expect(check(["rib-5-left"])).not.toThrow();
  expect(check(["t1"])).toThrow('steps[0].view.measurements[0].points[0].body: the scene "thorax" has no body "rib-5-left"'); // prettier-ignore
});

describe.each(names)("the lesson %s", (name) => {
  const lesson = read(name);
  const { steps } = lesson;
  const scene = sceneOf(lesson.scene);

  test("ClaimsEveryNumberOfItsCaptions", () => {
    const unclaimed = steps.flatMap((step) =>
      numbersIn(step.caption)
        .filter((number) => !isClaimed(scene, step.claims, number))
        .map(({ unit, value }) => `${step.title}: ${value} ${unit}`),
    );
    expect(unclaimed).toEqual([]);
  });

  test("ClaimsSomethingInEveryStepAndNamesPresetsOfTheScene", () => {
    for (const step of steps) {
      expect(step.claims.length, step.title).toBeGreaterThan(0);
      // A scene without presets has none to name.
      if (scene.includes("presets {")) expect(scene).toContain(`name: "${presetOf(lesson, step)}"`);
      else expect(presetOf(lesson, step)).toBe("");
      for (const { measure } of step.claims) expect(scene).toContain(`measures { name: "${measure}"`);
    }
  });

  test("ClaimsTheNumberThatAnswersAQuestionInItsStepOrTheNext", () => {
    const unclaimed = steps.flatMap(({ question, title, claims }, i) => {
      const { number } = question ?? {};
      if (number === undefined) return [];
      const known = [...claims, ...(steps[i + 1]?.claims ?? [])];
      return isClaimed(scene, known, quantity(number.value, number.unit))
        ? []
        : [`${title}: ${number.value} ${number.unit}`];
    });
    expect(unclaimed).toEqual([]);
  });

  test("HasTheNamesOfItsScene", () => {
    expect(() =>
      checkLesson(lesson, sceneNames(lesson.scene, layersOf(scene), predictable, bodiesOf(scene))),
    ).not.toThrow();
  });

  test("HasARightAnswerToEveryQuestion", () => {
    for (const { question, title } of steps) {
      if (question === undefined) continue;
      const answerable =
        question.prediction !== undefined ||
        question.number !== undefined ||
        question.answers.some(({ right }) => right);
      expect(answerable, title).toBe(true);
      expect(question.explanation, title).not.toBe("");
    }
  });
});
