import { make } from "../../dom/elements";
import { AnswerPhase } from "../../gen/phrenic/v1/answers_pb";
import type { Lesson } from "../../gen/phrenic/v1/lesson_pb";
import type { GivenAnswer } from "../../session/class_answers";
import { questionFields } from "./question_form";
import { t } from "../../language/translate";

/** How many of a test's questions were answered rightly. */
export interface Score {
  right: number;
  of: number;
}

/** Receives the answer to the question of a step, from 1. */
export type OnAnswer = (step: number, phase: AnswerPhase, answer: GivenAnswer) => void;

/** Returns the number of questions that a test can ask: all but those whose answer is a drawn curve. */
export function questionCount({ steps }: Lesson): number {
  return steps.filter(({ question }) => question !== undefined && question.prediction === undefined).length;
}

/**
 * Returns a form with all questions of a lesson that a test can ask, without saying which answers are right. Calls
 * `answered` for each question when the form is handed in, and then `done`. Questions without an answer count as wrong.
 */
export function lessonTest(
  lesson: Lesson,
  phase: AnswerPhase.BEFORE | AnswerPhase.AFTER,
  answered: OnAnswer,
  done: (score: Score) => void,
): HTMLElement {
  const asked = lesson.steps.flatMap(({ question }, i) =>
    question === undefined || question.prediction !== undefined
      ? []
      : [{ step: i + 1, ...questionFields(question, `test-${i}`) }],
  );
  const groups = asked.map(({ legend, rows }) => make("fieldset", { className: "question" }, legend, ...rows));
  const hand = make("button", { type: "submit", className: "primary" }, t("Hand in"));
  const words = phase === AnswerPhase.BEFORE ? t("What do you think before the lesson?") : t("And now?");
  const title = make("h3", { tabIndex: -1 }, words);
  const form = make("form", { id: "lesson-test" }, title, ...groups, hand);
  form.onsubmit = (event) => {
    event.preventDefault();
    const answers = asked.map(({ step, given }) => ({ step, answer: given() }));
    for (const { step, answer } of answers) if (answer !== undefined) answered(step, phase, answer);
    done({ right: answers.filter(({ answer }) => answer?.right === true).length, of: asked.length });
  };
  return form;
}

/** Returns the difference of two tests in words. */
export function differenceWords(before: Score, after: Score): string {
  const more = after.right - before.right;
  const change = more === 0 ? t("as many") : more > 0 ? t("{0} more", more) : t("{0} fewer", -more);
  const words = "Before the lesson {0} of {1} right, after it {2} of {3}: {4}.";
  return t(words, before.right, before.of, after.right, after.of, change);
}
