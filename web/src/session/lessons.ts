import type { JsonValue } from "@bufbuild/protobuf";
import type { Lesson, LessonStep, LessonView, Question } from "../gen/phrenic/v1/lesson_pb";
import { pageLanguage } from "../language/language";
import type { Messages } from "../language/translate";
import { readLesson } from "./lesson_file";
import { withWords } from "./lesson_words";

/** A place in a lesson: the name of its file and the number of a step from 1. */
export interface LessonPlace {
  name: string;
  step: number;
}

/** Returns the parsed JSON of a file of the page. Throws Error if the server does not return it. */
export type FetchJson = (path: string) => Promise<JsonValue>;

/** Fetches a file that is served beside the page. */
export const fetchJson: FetchJson = async (path) => {
  const response = await fetch(path);
  if (!response.ok) throw new Error(`${path}: the server answered with HTTP status ${response.status}`);
  return (await response.json()) as JsonValue;
};

/** Returns the names of the lessons in the order in which they are taught. */
export async function lessonNames(fetchFile: FetchJson): Promise<string[]> {
  return (await fetchFile("lessons/index.json")) as string[];
}

/**
 * Returns a lesson by the name of its file, in the language of the page. Throws Error for an unknown name, field or
 * value.
 */
export async function loadLesson(name: string, fetchFile: FetchJson): Promise<Lesson> {
  if (!/^[a-z0-9-]+$/.test(name)) throw new Error(`lesson: "${name}" is not a name of letters a-z, digits and "-"`);
  const lesson = readLesson(`lessons/${name}.json`, await fetchFile(`lessons/${name}.json`));
  const language = pageLanguage();
  if (language === "en") return lesson;
  // A lesson that is not translated is played in English.
  const words = await fetchFile(`languages/${language}/${name}.json`).catch(() => ({}));
  return withWords(lesson, words as Messages);
}

/** The scene of a session, and the names that the views of its lessons may use. */
export interface SceneNames {
  scene: string;
  cameras: readonly string[];
  cuts: readonly string[];
  colourings: readonly string[];
  layers: readonly string[];
  /** Measures whose course can be predicted. */
  predicted: readonly string[];
  bodies: readonly string[];
}

/** Throws Error if the lesson is about another scene, or, naming the field, if a view has an unknown name. */
export function checkLesson({ scene, steps }: Lesson, names: SceneNames): void {
  if (scene !== names.scene)
    throw new Error(
      `it is about the scene "${scene}" and this session shows "${names.scene}": open a session of "${scene}"`,
    );
  steps.forEach(({ view }, i) => view && checkView(view, `steps[${i}].view`, names));
  steps.forEach(({ question }, i) => {
    const measure = question?.prediction?.measure;
    if (measure === undefined || names.predicted.includes(measure)) return;
    const known = names.predicted.join(", ") || "none";
    throw new Error(`steps[${i}].question.prediction.measure: "${measure}" is not one of ${known}`);
  });
}

function checkView(view: LessonView, path: string, names: SceneNames): void {
  const { camera, cut, colouring, hiddenLayers, measurements } = view;
  const fields: [string, string[], readonly string[]][] = [
    ["camera", [camera], names.cameras],
    ["cut", [cut], names.cuts],
    ["colouring", [colouring], names.colourings],
    ["hiddenLayers", hiddenLayers, names.layers],
  ];
  for (const [field, values, known] of fields) {
    const unknown = values.find((value) => value !== "" && !known.includes(value));
    if (unknown !== undefined) throw new Error(`${path}.${field}: "${unknown}" is not one of ${known.join(", ")}`);
  }
  for (const [i, { points }] of measurements.entries()) {
    const k = points.findIndex(({ body }) => !names.bodies.includes(body));
    if (k >= 0)
      throw new Error(
        `${path}.measurements[${i}].points[${k}].body: the scene "${names.scene}" has no body "${points[k].body}"`,
      );
  }
}

/** Returns the preset of a step: its own or that of the last step before that names one. */
export function presetOf(lesson: Lesson, step: LessonStep): string {
  const before = lesson.steps.slice(0, lesson.steps.indexOf(step) + 1);
  return before.findLast(({ preset }) => preset !== "")?.preset ?? "";
}

/** Returns the place of an address, "lesson=copd&step=2"; undefined if it names no lesson. */
export function lessonPlaceOf(address: URL): LessonPlace | undefined {
  const name = address.searchParams.get("lesson") ?? "";
  const step = Number(address.searchParams.get("step") ?? "1");
  return name === "" ? undefined : { name, step: Number.isInteger(step) && step > 0 ? step : 1 };
}

/** Returns the query string with this place in it, or without any. */
export function withLessonPlace(query: string, place: LessonPlace | undefined): string {
  const parameters = new URLSearchParams(query);
  for (const key of ["lesson", "step"]) parameters.delete(key);
  if (place !== undefined) {
    parameters.set("lesson", place.name);
    parameters.set("step", String(place.step));
  }
  return `?${parameters}`;
}

/** True if the chosen answers, by index, are the right ones. */
export function rightAnswers({ answers }: Question, chosen: number[]): boolean {
  return answers.every(({ right }, i) => right === chosen.includes(i));
}

/** True if a number is within the tolerance of the question. */
export function rightNumber({ number }: Question, value: number): boolean {
  return number !== undefined && Math.abs(value - number.value) <= number.tolerance;
}
