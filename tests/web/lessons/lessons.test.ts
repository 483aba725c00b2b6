import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { fromJsonString } from "@bufbuild/protobuf";
import { describe, expect, test } from "vitest";
import { LessonSchema, type LessonStep } from "../../../web/src/gen/phrenic/v1/lesson_pb";
import { presetOf } from "../../../web/src/session/lessons";

const web = join(import.meta.dirname, "../../../web");
const folder = join(web, "public/lessons");
const names = JSON.parse(readFileSync(join(folder, "index.json"), "utf8")) as string[];
const scene = readFileSync(join(web, "../server/scenes/thorax.textproto"), "utf8");
const read = (name: string) => fromJsonString(LessonSchema, readFileSync(join(folder, `${name}.json`), "utf8"));

const units: Record<string, number> = { mm: 1e-3, l: 1e-3, "cmH₂O": 98.0665 };

/** Returns the numbers with a unit in a caption, in SI units. */
function numbersIn(caption: string): number[] {
  const found = caption.matchAll(/([−]?\d+(?:\.\d+)?) (mm|l|cmH₂O)(?![a-z])/g);
  return [...found].map(([, digits, unit]) => Number(digits.replace("−", "-")) * units[unit]);
}

/** True if the limits of a claim of the step contain the number, whichever way it is counted. */
function isClaimed({ claims }: LessonStep, number: number): boolean {
  const within = (value: number) =>
    claims.some(
      ({ minimum, maximum }) => minimum !== undefined && maximum !== undefined && value >= minimum && value <= maximum,
    );
  return within(number) || within(-number);
}

test("TheIndexNamesEveryLesson", () => {
  const files = readdirSync(folder).filter((file) => file !== "index.json");
  expect(names.map((name) => `${name}.json`).sort()).toEqual(files.sort());
});

test("ANumberOfACaptionIsRead", () => {
  expect(numbersIn("falls by 14 mm, brings 0.5 l at −3 cmH₂O, three times")).toEqual([0.014, 0.0005, -294.1995]);
});

describe.each(names)("the lesson %s", (name) => {
  const { steps } = read(name);

  test("ClaimsEveryNumberOfItsCaptions", () => {
    const unclaimed = steps.flatMap((step) =>
      numbersIn(step.caption).filter((number) => !isClaimed(step, number)).map((number) => `${step.title}: ${number}`),
    ); // prettier-ignore
    expect(unclaimed).toEqual([]);
  });

  test("ClaimsSomethingInEveryStepAndNamesPresetsOfTheScene", () => {
    const lesson = read(name);
    for (const step of lesson.steps) {
      expect(step.claims.length, step.title).toBeGreaterThan(0);
      expect(scene).toContain(`name: "${presetOf(lesson, step)}"`);
      for (const { measure } of step.claims) expect(scene).toContain(`measures { name: "${measure}"`);
    }
  });

  test("HasARightAnswerToEveryQuestion", () => {
    for (const { question, title } of steps) {
      if (question === undefined) continue;
      const answerable = question.number !== undefined || question.answers.some(({ right }) => right);
      expect(answerable, title).toBe(true);
      expect(question.explanation, title).not.toBe("");
    }
  });
});
