import { clone } from "@bufbuild/protobuf";
import { type Lesson, LessonSchema } from "../gen/phrenic/v1/lesson_pb";
import type { Messages } from "../language/translate";

/** Returns a copy of a lesson of which `change` has replaced every text that a pupil reads. */
function withTexts(lesson: Lesson, change: (text: string) => string): Lesson {
  const copy = clone(LessonSchema, lesson);
  [copy.title, copy.summary] = [change(copy.title), change(copy.summary)];
  for (const step of copy.steps) {
    [step.title, step.caption, step.task] = [change(step.title), change(step.caption), change(step.task)];
    const { question } = step;
    if (question === undefined) continue;
    [question.words, question.explanation] = [change(question.words), change(question.explanation)];
    for (const answer of question.answers) answer.words = change(answer.words);
  }
  return copy;
}

/** Returns a lesson in the words of another language; texts that it lacks stay. */
export function withWords(lesson: Lesson, words: Messages): Lesson {
  return withTexts(lesson, (text) => words[text] ?? text);
}

/** Returns the texts of a lesson that a pupil reads, each once. */
export function textsOf(lesson: Lesson): string[] {
  const texts = new Set<string>();
  withTexts(lesson, (text) => {
    if (text !== "") texts.add(text);
    return text;
  });
  return [...texts];
}
