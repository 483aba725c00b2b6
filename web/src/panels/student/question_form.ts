import { make } from "../../dom/elements";
import type { Question } from "../../gen/phrenic/v1/lesson_pb";
import { rightAnswers, rightNumber } from "../../session/lessons";

/** A question with its answers, a button that checks them, and the explanation; it can be tried again. */
export function questionForm(question: Question): HTMLElement {
  const result = make("p", { className: "answer" });
  result.setAttribute("role", "status");
  const { rows, right } = question.number === undefined ? choiceRows(question) : numberRow(question);
  const check = make("button", { type: "submit" }, "Check");
  const fields = make(
    "fieldset",
    { className: "question" },
    make("legend", {}, question.words),
    ...rows,
    check,
    result,
  );
  const form = make("form", {}, fields);
  form.onsubmit = (event) => {
    event.preventDefault();
    const answered = right();
    result.textContent =
      answered === undefined
        ? "Choose an answer first."
        : `${answered ? "Right." : "Not yet."} ${answered ? question.explanation : "Look again and try once more."}`;
    result.dataset.right = String(answered === true);
  };
  return form;
}

interface Rows {
  rows: HTMLElement[];
  /** True if the answer is right; undefined if nothing was entered. */
  right(): boolean | undefined;
}

function choiceRows(question: Question): Rows {
  const several = question.answers.filter(({ right }) => right).length > 1;
  const inputs = question.answers.map(() => make("input", { type: several ? "checkbox" : "radio", name: "answer" }));
  const rows = question.answers.map(({ words }, i) => make("label", {}, inputs[i], words));
  const chosen = () => inputs.flatMap(({ checked }, i) => (checked ? [i] : []));
  return { rows, right: () => (chosen().length === 0 ? undefined : rightAnswers(question, chosen())) };
}

function numberRow(question: Question): Rows {
  const unit = question.number?.unit ?? "";
  const input = make("input", { type: "number", step: "any", ariaLabel: `Your answer in ${unit}` });
  const right = () => (Number.isNaN(input.valueAsNumber) ? undefined : rightNumber(question, input.valueAsNumber));
  return { rows: [make("label", {}, input, ` ${unit}`)], right };
}
