import { AnswerPhase, type ClassAnswer } from "../gen/phrenic/v1/answers_pb";
import type { Lesson, Question } from "../gen/phrenic/v1/lesson_pb";

/** The answers of a class to one question while the lesson is played. */
export interface QuestionSummary {
  answered: number;
  right: number;
  firstRight: number;
  /** How many chose each answer; empty for a number. */
  counts: number[];
  /** The numbers that were given, ascending. */
  numbers: number[];
}

/** Returns the summary of the answers to the question of a step, from 1. */
export function summaryOf(answers: ClassAnswer[], step: number, question: Question): QuestionSummary {
  const given = answers.filter((each) => each.step === step && each.phase === AnswerPhase.UNSPECIFIED);
  return {
    answered: given.length,
    right: given.filter(({ right }) => right).length,
    firstRight: given.filter(({ firstRight }) => firstRight).length,
    counts: question.answers.map((_, i) => given.filter(({ choices }) => choices.includes(i)).length),
    numbers: given.flatMap(({ number }) => number ?? []).sort((a, b) => a - b),
  };
}

/** The tests before and after a lesson, of those who have taken both: mean shares of right answers, 0 to 1. */
export interface TestComparison {
  respondents: number;
  before: number;
  after: number;
}

/** Returns the comparison; undefined if no respondent has taken both tests. */
export function compareTests(answers: ClassAnswer[]): TestComparison | undefined {
  const numbers = [...new Set(answers.map(({ respondent }) => respondent))];
  const pairs = numbers.flatMap((respondent) => {
    const own = answers.filter((each) => each.respondent === respondent);
    const [before, after] = [shareRight(own, AnswerPhase.BEFORE), shareRight(own, AnswerPhase.AFTER)];
    return before === undefined || after === undefined ? [] : [{ before, after }];
  });
  if (pairs.length === 0) return undefined;
  const mean = (values: number[]) => values.reduce((sum, value) => sum + value, 0) / values.length;
  return {
    respondents: pairs.length,
    before: mean(pairs.map(({ before }) => before)),
    after: mean(pairs.map(({ after }) => after)),
  };
}

function shareRight(answers: ClassAnswer[], wanted: AnswerPhase): number | undefined {
  const taken = answers.filter(({ phase }) => phase === wanted);
  return taken.length === 0 ? undefined : taken.filter(({ right }) => right).length / taken.length;
}

const phaseNames = new Map([
  [AnswerPhase.UNSPECIFIED, "lesson"],
  [AnswerPhase.BEFORE, "before"],
  [AnswerPhase.AFTER, "after"],
]);

/** Returns the answers as CSV (RFC 4180), one row each; cells of text never start a formula of a spreadsheet. */
export function answersCsv(answers: ClassAnswer[], lesson: Lesson): string {
  const head = [
    "respondent",
    "name",
    "lesson",
    "step",
    "asked",
    "question",
    "answer",
    "right",
    "first right",
    "attempts",
  ];
  const rows = answers.map((each) => {
    const question = lesson.steps[each.step - 1]?.question;
    const words = each.choices.map((choice) => question?.answers[choice]?.words ?? `answer ${choice + 1}`);
    const answer = each.number === undefined ? cell(words.join("; ")) : String(each.number);
    const asked = phaseNames.get(each.phase) ?? "";
    const texts = [each.name, each.lesson].map(cell);
    const outcome = [each.right, each.firstRight].map((right) => (right ? "yes" : "no"));
    return [
      each.respondent,
      ...texts,
      each.step,
      asked,
      cell(question?.words ?? ""),
      answer,
      ...outcome,
      each.attempts,
    ];
  });
  return [head, ...rows].map((row) => `${row.join(",")}\r\n`).join("");
}

function cell(words: string): string {
  const safe = /^[=+\-@\t\r]/.test(words) ? `'${words}` : words;
  return /[",\r\n]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}
