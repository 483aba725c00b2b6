import { make } from "../dom/elements";
import type { Parameters } from "../gen/phrenic/v1/parameters_pb";
import type { Study } from "../gen/phrenic/v1/study_pb";
import type { StudyResult } from "../gen/phrenic/v1/study_results_pb";
import { type Control, parameterControls } from "../parameters/controls";
import { formatDigits } from "./format";
import { seriesName } from "./names";

const kinds = {
  error: "Error against run time",
  stability: "Stability",
  cost: "Cost",
  streaming: "Error against bandwidth",
  physiology: "Physiology",
  sensitivity: "Sensitivity",
  uncertainty: "Uncertainty",
  convergence: "Convergence of the outputs",
  credibility: "Credibility",
};

/** Returns "Cost: thorax – Phrenic". */
export function titleOf(study: Study): string {
  const { title, scene } = studyNames(study);
  return `${title}: ${scene} – Phrenic`;
}

function studyNames({ result, scene }: Study): { title: string; scene: string } {
  const kind = result?.result.case;
  return { title: kind === undefined ? "Study" : kinds[kind], scene: result?.scene || scene || "unnamed scene" };
}

/** The page header: kind of study, scene and parameters. */
export function header(study: Study): HTMLElement {
  const { result } = study;
  const { title, scene } = studyNames(study);
  const facts: [string, string][] = [];
  if (result !== undefined) facts.push(...factsOf(result));
  const list = facts.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]);
  return make(
    "header",
    {},
    make(
      "div",
      { className: "over-row" },
      make("p", { className: "over" }, `Phrenic study${study.id === "" ? "" : ` ${study.id}`}`),
      make("p", { className: "disclaimer" }, "Research and teaching; not for clinical use"),
    ),
    make("h1", {}, `${title}: `, make("span", { className: "scene" }, scene)),
    ...(list.length === 0 ? [] : [make("dl", {}, ...list)]),
  );
}

function factsOf({ sceneHash, parameters, tookS, result }: StudyResult): [string, string][] {
  const facts: [string, string][] = [];
  if (parameters !== undefined) facts.push(["Parameters", parameterSummary(parameters)]);
  const simulated = result.case === "error" ? result.value.seconds : 0;
  const took = `the study took ${formatDigits(tookS, 3)} s`;
  if (result.case !== "physiology" && result.case !== "credibility")
    facts.push(["Duration", simulated > 0 ? `${formatDigits(simulated)} s simulated; ${took}` : took]);
  if (sceneHash !== "") facts.push(["Scene's hash", sceneHash]);
  return facts;
}

/** Returns "time step 0.005 s · breath force 1 · ...". */
export function parameterSummary(parameters: Parameters): string {
  const values = parameters as unknown as Record<string, unknown>;
  return parameterControls()
    .filter(({ field }) => values[field] !== undefined)
    .map((control) => `${control.label.toLowerCase()} ${formatParameter(control, values[control.field])}`)
    .join(" · ");
}

function formatParameter(control: Control, value: unknown): string {
  if (control.kind === "switch") return value === true ? "on" : "off";
  if (control.kind === "choice") {
    const label = control.options.find((each) => each.value === value)?.label ?? String(value);
    return seriesName(label.toLowerCase().replaceAll(" ", "_"));
  }
  return `${formatDigits(Number(value))}${control.unit === "" ? "" : ` ${control.unit}`}`;
}
