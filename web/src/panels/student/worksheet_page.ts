import { make } from "../../dom/elements";
import { switchRow } from "../../dom/rows";
import type { Lesson } from "../../gen/phrenic/v1/lesson_pb";
import { answerSheet, worksheet, type WorksheetParts } from "./worksheet";
import { t } from "../../language/translate";

/** Who prints, and what happens afterwards. */
export interface WorksheetUse {
  /** True for a teacher, who may also print the answers. */
  teaches: boolean;
  print(): void;
  closed(): void;
}

/**
 * Shows the worksheet of a lesson over the page, with buttons that print and close it; a printer gets only the sheets.
 * Escape closes it.
 */
export function openWorksheet(lesson: Lesson, parts: WorksheetParts, use: WorksheetUse): void {
  const page = make("div", { id: "worksheet", ariaLabel: t("Worksheet"), ariaModal: "true" });
  page.setAttribute("role", "dialog");
  const [title, hidden] = [document.title, [...document.body.children] as HTMLElement[]];
  const others = hidden.filter(({ inert }) => !inert);
  const close = () => {
    page.remove();
    for (const each of others) each.inert = false;
    document.title = title;
    use.closed();
  };
  const answers = answerSheet(lesson);
  answers.hidden = true;
  page.append(bar(answers, use, close), worksheet(lesson, parts), answers);
  page.addEventListener("keydown", ({ key }) => {
    if (key === "Escape") close();
  });
  for (const each of others) each.inert = true;
  document.body.append(page);
  // Printers and PDF files get the title of the page.
  document.title = lesson.title;
  page.querySelector("button")?.focus();
}

function bar(answers: HTMLElement, { teaches, print }: WorksheetUse, close: () => void): HTMLElement {
  const go = make(
    "button",
    { type: "button", id: "worksheet-print", className: "primary", onclick: print },
    t("Print"),
  );
  const end = make("button", { type: "button", id: "worksheet-close", onclick: close }, t("Close"));
  const help = t("The right answers on a page of their own");
  const { row } = switchRow(t("Answers for the teacher"), help, (on) => (answers.hidden = !on));
  row.id = "worksheet-answers";
  const note = make("p", {}, t("The steps that you have played have pictures."));
  return make("div", { className: "worksheet-bar" }, go, end, ...(teaches ? [row] : []), note);
}
