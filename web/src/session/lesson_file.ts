import { fromJson, type JsonValue, toJson } from "@bufbuild/protobuf";
import {
  type Lesson,
  LessonSchema,
  type LessonStep,
  type LessonView,
  type PredictedCurve,
  type Question,
} from "../gen/phrenic/v1/lesson_pb";
import { faultOfMeasurement, mostMeasurements } from "../geometry/measuring";

/** Largest size of a lesson's file [bytes], and most steps. */
const maxBytes = 1_000_000;
const maxSteps = 100;
/** Most answers of a question: the server keeps the class's answers by index. */
const maxAnswers = 16;

/** Returns a lesson from the text of a file. Throws Error naming the file, and the field or the place of the fault. */
export function readLessonFile(name: string, text: string): Lesson {
  if (text.length > maxBytes) throw new Error(`${name}: the file is larger than 1 MB`);
  let json: JsonValue;
  try {
    json = JSON.parse(text) as JsonValue;
  } catch (error) {
    throw new Error(`${name}: this is not JSON: ${(error as Error).message}`);
  }
  return readLesson(name, json);
}

/** Returns a lesson from parsed JSON. Throws Error naming the file and the field that is unknown, wrong or missing. */
export function readLesson(name: string, json: JsonValue): Lesson {
  let lesson: Lesson;
  try {
    lesson = fromJson(LessonSchema, json);
  } catch (error) {
    throw new Error(`${name}: ${(error as Error).message}`);
  }
  const fault = faultOf(lesson);
  if (fault !== undefined) throw new Error(`${name}: ${fault}`);
  return lesson;
}

/** Returns the text of a lesson's file. */
export function lessonText(lesson: Lesson): string {
  return `${JSON.stringify(toJson(LessonSchema, lesson), undefined, 2)}\n`;
}

/** Returns what a lesson lacks, naming the field; undefined if it is complete. */
export function faultOf({ title, scene, steps }: Lesson): string | undefined {
  if (title.trim() === "") return "title: a lesson needs one";
  if (scene === "") return "scene: name the scene that the lesson is about";
  if (steps.length === 0) return "steps: a lesson needs at least one";
  if (steps.length > maxSteps) return `steps: a lesson has at most ${maxSteps}`;
  for (const [i, step] of steps.entries()) {
    const fault = faultOfStep(step);
    if (fault !== undefined) return `steps[${i}].${fault}`;
  }
  return undefined;
}

/** Returns what a step lacks, naming the field; undefined if it is complete. */
export function faultOfStep({ title, caption, view, question }: LessonStep): string | undefined {
  if (title.trim() === "") return "title: a step needs one";
  if (caption.trim() === "") return "caption: say what is seen and why";
  const { cutPosition = 0, pose, colourTop = 1, colouring = "" } = view ?? {};
  if (!(Number.isFinite(colourTop) && colourTop > 0)) return `view.colourTop: ${colourTop} is not above 0`;
  if (view?.colourTop !== undefined && (colouring === "" || colouring === "own"))
    return "view.colourTop: a scale needs view.colouring, the name of a field";
  if (!(cutPosition >= 0 && cutPosition <= 1)) return `view.cutPosition: ${cutPosition} is not between 0 and 1`;
  const places = pose === undefined ? [] : [pose.eye, pose.target];
  if (places.some((place) => ![place?.x, place?.y, place?.z].every(Number.isFinite)))
    return "view.pose: eye and target need three numbers each";
  return (view && faultOfMeasurements(view)) ?? (question && faultOfQuestion(question));
}

function faultOfMeasurements({ measurements }: LessonView): string | undefined {
  if (measurements.length > mostMeasurements) return `view.measurements: a step has at most ${mostMeasurements}`;
  for (const [i, { tool, points }] of measurements.entries()) {
    const fault = faultOfMeasurement(tool, points);
    if (fault !== undefined) return `view.measurements[${i}].${fault}`;
  }
  return undefined;
}

function faultOfQuestion({ words, answers, number, explanation, prediction }: Question): string | undefined {
  if (words.trim() === "") return "question.words: a question needs words";
  if (explanation.trim() === "") return "question.explanation: say why the right answer is right";
  if (prediction !== undefined) {
    if (answers.length > 0 || number !== undefined)
      return "question.prediction: give either answers, a number or a prediction";
    return faultOfPrediction(prediction);
  }
  if (number !== undefined) {
    if (answers.length > 0) return "question.answers: give either answers or a number";
    if (!Number.isFinite(number.value)) return "question.number.value: it must be a number";
    return number.tolerance >= 0 ? undefined : "question.number.tolerance: it must be 0 or more";
  }
  if (answers.length < 2) return "question.answers: give two or more answers, or a number";
  if (answers.length > maxAnswers) return `question.answers: give at most ${maxAnswers}`;
  if (answers.some((answer) => answer.words.trim() === "")) return "question.answers: each needs words";
  return answers.some(({ right }) => right) ? undefined : "question.answers: mark at least one as right";
}

function faultOfPrediction({ measure, tolerance }: PredictedCurve): string | undefined {
  if (measure.trim() === "") return "question.prediction.measure: name a measure of the scene";
  const good = Number.isFinite(tolerance) && tolerance > 0;
  return good ? undefined : "question.prediction.tolerance: it must be above 0";
}
