import { create } from "@bufbuild/protobuf";
import { describe, expect, test, vi } from "vitest";
import { Identity } from "../../../web/src/connection/identity";
import { AnswerPhase, ClassAnswerSchema } from "../../../web/src/gen/phrenic/v1/answers_pb";
import { LessonSchema } from "../../../web/src/gen/phrenic/v1/lesson_pb";
import { ClassResults } from "../../../web/src/panels/student/class_results";
import { answersCsv, compareTests, summaryOf } from "../../../web/src/session/answer_summary";
import { ClassAnswers } from "../../../web/src/session/class_answers";
import { settle } from "../fakes/fake_clock";
import { FakeServer } from "../fakes/fake_server";

const question = { words: "Which, and why?", answers: [{ words: "this", right: true }, { words: "that" }] };
const lesson = create(LessonSchema, { title: "A breath", scene: "thorax", steps: [{ title: "One" }, { question }] });
const given = (respondent: number, choice: number, more: object = {}) =>
  create(ClassAnswerSchema, {
    respondent,
    lesson: "copd",
    step: 2,
    choices: [choice],
    right: choice === 0,
    firstRight: choice === 0,
    attempts: 1,
    ...more,
  });

function storage() {
  const stored = new Map<string, string>();
  return {
    getItem: (key: string) => stored.get(key) ?? null,
    setItem: (k: string, v: string) => void stored.set(k, v),
  };
}

test("AnAnswerCarriesTheSecretOfTheBrowserAndANameOnlyIfThereIsOne", async () => {
  const server = new FakeServer();
  const identity = new Identity(storage());
  const answers = new ClassAnswers(server.api, "thorax", identity);
  const place = { lesson: "copd", step: 2, phase: AnswerPhase.UNSPECIFIED };
  await answers.submit(place, { choices: [1], number: undefined, right: false });
  identity.name = "Ben";
  await answers.submit(place, { choices: [], number: 1.5, right: true });
  expect(server.answers.map(({ name, choices, number, right }) => [name, choices, number, right])).toEqual([
    ["", [1], undefined, false],
    ["Ben", [], 1.5, true],
  ]);
  const secrets = server.answers.map(({ respondent }) => respondent);
  expect(secrets[0]).toMatch(/^[0-9a-f]{32}$/);
  expect(secrets[1]).toBe(secrets[0]);
});

test("ALostConnectionDoesNotStopALesson", async () => {
  const server = new FakeServer();
  server.down = true;
  const answers = new ClassAnswers(server.api, "thorax", new Identity(storage()));
  const place = { lesson: "copd", step: 2, phase: AnswerPhase.UNSPECIFIED };
  await answers.submit(place, { choices: [1], number: undefined, right: false });
  await expect(answers.list("copd", false)).rejects.toThrow(Error);
});

describe("the summary", () => {
  test("CountsAnswersOfTheLessonAlone", () => {
    const answers = [
      given(1, 0),
      given(2, 1),
      given(3, 0, { firstRight: false, attempts: 2 }),
      given(3, 1, { phase: AnswerPhase.BEFORE }),
      given(4, 0, { step: 1 }),
    ];
    expect(summaryOf(answers, 2, lesson.steps[1].question!)).toEqual({
      answered: 3,
      right: 2,
      firstRight: 1,
      counts: [2, 1],
      numbers: [],
    });
  });

  test("ComparesTheTestsOfThoseWhoTookBoth", () => {
    const test = (respondent: number, phase: AnswerPhase, ...choices: number[]) =>
      choices.map((choice, i) => given(respondent, choice, { phase, step: i + 1 }));
    const { BEFORE, AFTER } = AnswerPhase;
    const answers = [
      ...test(1, BEFORE, 1, 1), ...test(1, AFTER, 0, 0), ...test(2, BEFORE, 0, 1), ...test(2, AFTER, 0, 1),
      ...test(3, BEFORE, 0, 0),
    ]; // prettier-ignore
    expect(compareTests(answers)).toEqual({ respondents: 2, before: 0.25, after: 0.75 });
    expect(compareTests(test(3, BEFORE, 0))).toBeUndefined();
  });

  test("IsSavedAsCsvThatNoSpreadsheetRuns", () => {
    const rows = answersCsv([given(1, 0, { name: "=1+1" }), given(2, 1, { name: 'A "B", C' })], lesson).split("\r\n");
    expect(rows[0]).toBe("respondent,name,lesson,step,asked,question,answer,right,first right,attempts");
    expect(rows[1]).toBe(`1,'=1+1,copd,2,lesson,"Which, and why?",this,yes,yes,1`);
    expect(rows[2]).toBe(`2,"A ""B"", C",copd,2,lesson,"Which, and why?",that,no,no,1`);
  });
});

describe("the results of a class", () => {
  const shown = { name: "copd", lesson, step: 2 };
  async function opened(list: () => Promise<ReturnType<typeof given>[]>) {
    const results = new ClassResults(list);
    document.body.replaceChildren(results.element);
    results.show(shown);
    results.element.open = true;
    await settle();
    return results;
  }

  test("AreLiveWhileTheyAreOpen", async () => {
    vi.useFakeTimers();
    const answers = [given(1, 0)];
    const results = new ClassResults(async () => answers);
    document.body.replaceChildren(results.element);
    results.show(shown);
    results.element.open = true;
    await vi.advanceTimersByTimeAsync(10);
    expect(results.element.textContent).toContain("1 answered, 1 right, 1 at the first attempt.");
    answers.push(given(2, 1));
    await vi.advanceTimersByTimeAsync(2100);
    expect(results.element.textContent).toContain("2 answered, 1 right");
    results.element.remove();
    answers.push(given(3, 1));
    await vi.advanceTimersByTimeAsync(10_000);
    expect(results.element.textContent).toContain("2 answered");
    expect(vi.getTimerCount()).toBe(0);
    vi.useRealTimers();
  });

  test("HaveNoNamesUnlessTheTeacherAsks", async () => {
    const asked: boolean[] = [];
    const list = async (_: string, names: boolean) => {
      asked.push(names);
      return [given(1, 0, { name: names ? "Ben" : "" })];
    };
    const { element } = await opened(list as never);
    expect(element.textContent).not.toContain("Ben");
    element.querySelector<HTMLInputElement>('input[role="switch"]')!.click();
    await settle();
    expect(asked).toEqual([false, true]);
    expect(element.textContent).toContain("Ben: this ✓");
    element.remove();
  });

  test("GoOnWithoutNamesIfTheServerRefusesThose", async () => {
    const list = async (_: string, names: boolean) => {
      if (names) throw new Error("take control first");
      return [given(1, 0)];
    };
    const { element } = await opened(list as never);
    const names = element.querySelector<HTMLInputElement>('input[role="switch"]')!;
    names.click();
    await settle();
    expect(element.querySelector("[role=alert]")!.textContent).toBe("take control first");
    expect(names.checked).toBe(false);
    expect(element.textContent).toContain("1 answered");
    element.remove();
  });

  test("SayWhyTheServerRefuses", async () => {
    const { element } = await opened(() => Promise.reject(new Error("Anna controls this session")));
    expect(element.querySelector("[role=alert]")!.textContent).toBe("Anna controls this session");
    element.remove();
  });
});
