import { make } from "../../dom/elements";
import type { PredictedCurve, Question } from "../../gen/phrenic/v1/lesson_pb";
import type { GivenAnswer } from "../../session/class_answers";
import { fixed, t } from "../../language/translate";
import type { OnPredicted } from "./prediction_pad";

/**
 * A question whose answer is a curve: a button starts the prediction, and the mean distance from the breath that is
 * then played is the answer. It can be tried again.
 */
export function predictionForm(
  question: Question,
  { measure, tolerance }: PredictedCurve,
  predict: (measure: string, done: OnPredicted) => boolean,
  answered: (answer: GivenAnswer) => void,
): HTMLElement {
  const result = make("p", { className: "answer" });
  result.setAttribute("role", "status");
  const done: OnPredicted = (distance, { unit, digits }) => {
    const right = distance <= tolerance;
    const apart = t("{0} {1} apart.", fixed(distance, digits), unit);
    const words = right ? `${t("Right.")} ${question.explanation}` : `${t("Not yet.")} ${t("Try again.")}`;
    result.textContent = `${apart} ${words}`;
    result.dataset.right = String(right);
    answered({ choices: [], number: distance, right });
  };
  const onclick = () => {
    if (!predict(measure, done)) result.textContent = t("This session does not show {0}.", t(measure));
  };
  const start = make("button", { type: "button", id: "lesson-predict", onclick }, t("Draw your curve"));
  const legend = make("legend", {}, question.words);
  const refusal = make("p", { className: "faint", id: "lesson-refusal", hidden: true });
  return make("fieldset", { className: "question" }, legend, start, refusal, result);
}

/** Disables the form of a prediction within an element, if there is one, and says why; empty words enable it. */
export function refusePrediction(within: HTMLElement, words: string): void {
  const start = within.querySelector<HTMLButtonElement>("#lesson-predict");
  const refusal = within.querySelector<HTMLElement>("#lesson-refusal");
  if (start === null || refusal === null) return;
  start.disabled = words !== "";
  refusal.hidden = words === "";
  refusal.textContent = words;
}
