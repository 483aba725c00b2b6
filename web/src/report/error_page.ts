import { make } from "../dom/elements";
import {
  ErrorRowSchema,
  type ErrorTable,
  type Reference,
  ResidualRowSchema,
  ResolutionRowSchema,
} from "../gen/phrenic/v1/study_results_pb";
import { convergence } from "./convergence";
import { sideBySide } from "./figure";
import { formatDigits } from "./format";
import { withSeriesNames } from "./names";
import { positionErrors, residuals, resolutions } from "./residuals";
import { tableOf } from "./table";
import { type Measure, workPrecision } from "./work_precision";

/** Returns advice, plots and tables of an error study. */
export function errorParts(table: ErrorTable): HTMLElement[] {
  const parts: (HTMLElement | undefined)[] = [
    table.advice === "" ? undefined : make("p", { className: "advice" }, withSeriesNames(table.advice)),
    switched(table),
    convergence(table),
    sideBySide(residuals(table), positionErrors(table), resolutions(table)),
    table.reference === undefined ? undefined : referenceWords(table.reference),
    make("h2", {}, "Tables"),
    tableOf("Runs", ErrorRowSchema, table.rows),
    table.resolutions.length === 0 ? undefined : tableOf("Resolutions", ResolutionRowSchema, table.resolutions),
    table.residuals.length === 0 ? undefined : tableOf("Rigid links over time", ResidualRowSchema, table.residuals),
  ];
  return parts.filter((part) => part !== undefined);
}

const measures: [Measure, string][] = [
  ["errorRmsMm", "RMS error"],
  ["errorMaxMm", "Largest error"],
];

/** The work-precision diagram, with a choice of the error measure. */
function switched(table: ErrorTable): HTMLElement {
  const frame = make("div", {});
  const show = (measure: Measure) => frame.replaceChildren(workPrecision(table, measure));
  const choices = measures.map(([measure, label], i) => {
    const input = make("input", { type: "radio", name: "measure", checked: i === 0 });
    input.onchange = () => show(measure);
    return make("label", {}, input, label);
  });
  show("errorRmsMm");
  const choice = make("fieldset", { className: "choice" }, make("legend", {}, "Error shown"), ...choices);
  return make("section", {}, make("h2", {}, "Work and precision"), choice, frame);
}

function referenceWords(reference: Reference): HTMLElement {
  const { method, toleranceM, errorMaxMm, errorRmsMm, evaluations, cpuS, largestDisplacementMm } = reference;
  const sentence =
    `${method || "An independent solution"} at a tolerance of ${formatDigits(toleranceM)} m, with ` +
    `${formatDigits(Number(evaluations), 9)} evaluations in ${formatDigits(cpuS, 3)} s of CPU time. Against the same ` +
    `solution at a tenth of the tolerance its error is ${formatDigits(errorRmsMm, 3)} mm RMS (over the vertices that move freely, as in the tables) and ` +
    `${formatDigits(errorMaxMm, 3)} mm at most; vertices move by up to ` +
    `${formatDigits(largestDisplacementMm, 3)} mm.`;
  return make("section", {}, make("h2", {}, "The reference"), make("p", {}, sentence));
}
