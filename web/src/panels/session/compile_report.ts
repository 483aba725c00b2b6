import { make } from "../../dom/elements";
import { section } from "../../dom/rows";
import type { CompileReport } from "../../gen/phrenic/v1/report_pb";
import { formatNumber } from "../../parameters/numbers";
import type { Signal } from "../../state/signal";
import { decimal, t } from "../../language/translate";

const count = new Intl.NumberFormat("en");

/** The report of the scene's compilation: what runs, what was left out and why, and the largest stable step. */
export function compileReportPanel(report: Signal<CompileReport | undefined>): HTMLElement {
  const body = make("div", { className: "report" });
  report.subscribe((value) => body.replaceChildren(...(value === undefined ? [] : contents(value))));
  return section(t("Scene report"), false, body);
}

function contents(report: CompileReport): HTMLElement[] {
  return [totals(report), step(report), runs(report), leftOut(report), bodies(report), times(report), hash(report)];
}

function totals(report: CompileReport): HTMLElement {
  const numbers: [string, bigint][] = [
    ["vertices", report.simulatedVertices],
    ["springs", report.springs],
    ["rigid links", report.rigidLinks],
    ["attachments", report.attachments],
  ];
  const cells = numbers.map(([name, value]) =>
    make("div", {}, make("b", {}, count.format(value)), make("span", {}, t(name))),
  );
  return make("div", { className: "totals" }, ...cells);
}

function step({ stableStep }: CompileReport): HTMLElement {
  if (stableStep === undefined) return make("p");
  const { seconds, chosenSeconds, reason } = stableStep;
  const largest = make("b", {}, `${decimal(formatNumber(1000 * seconds))} ms`);
  return make(
    "p",
    {},
    t("Largest stable step "),
    largest,
    t(", chosen {0} ms. ", decimal(formatNumber(1000 * chosenSeconds))),
    reason,
  );
}

function list(title: string, items: [string, string][]): HTMLElement {
  if (items.length === 0) return make("div");
  const rows = items.flatMap(([term, detail]) => [make("dt", {}, term), make("dd", {}, detail)]);
  return make("div", {}, ...(title === "" ? [] : [make("h2", {}, title)]), make("dl", {}, ...rows));
}

function runs({ elements }: CompileReport): HTMLElement {
  const items = elements.map((element): [string, string] => [
    element.name || element.family,
    [`${count.format(element.count)} ${element.counted}`, element.detail].filter(Boolean).join("; "),
  ]);
  return list(t("Computed in every step"), items);
}

function leftOut(report: CompileReport): HTMLElement {
  return list(
    t("Left out"),
    report.leftOut.map(({ what, why }): [string, string] => [what, why]),
  );
}

/** Duration of each compilation stage. */
function times({ stages, compileSeconds }: CompileReport): HTMLElement {
  const part = (seconds: number) => Math.round((100 * seconds) / (compileSeconds || 1));
  const items = stages.map(({ name, seconds }): [string, string] => [
    name,
    `${decimal(formatNumber(1000 * seconds))} ms, ${part(seconds)} %`,
  ]);
  return list(t("Compile time by stage"), items);
}

function bodies(report: CompileReport): HTMLElement {
  const items = report.bodies.map((body): [string, string] => [
    body.name,
    `${body.role}, ${count.format(body.vertices)} vertices, ${count.format(body.triangles)} triangles`,
  ]);
  const details = make("details", {}, make("summary", {}, t("{0} bodies", items.length)));
  details.append(list("", items));
  return details;
}

function hash({ sceneHash, compileSeconds }: CompileReport): HTMLElement {
  const short = make("code", { title: sceneHash }, sceneHash.slice(0, 12));
  return make(
    "p",
    { className: "faint" },
    t("Compiled in {0} s. Scene ", decimal(formatNumber(compileSeconds))),
    short,
  );
}
